/** A button that asks for a file. */

interface Props {
  /** What is on it, and what it is called where that says too little by itself. */
  label: string;
  name?: string;
  accept: string;
  /** The id of what is wrong with the file that was chosen, where something is. */
  error?: string | undefined;
  onFile: (file: File) => void;
}

export function FileButton({ label, name = label, accept, error, onFile }: Props) {
  return (
    <label class="button file-button">
      <input
        type="file"
        class="visually-hidden"
        accept={accept}
        aria-label={name}
        aria-invalid={error !== undefined}
        aria-describedby={error}
        onChange={({ currentTarget }) => {
          const [file] = currentTarget.files ?? [];
          if (file) onFile(file);
          currentTarget.value = ''; // so that choosing the same file again counts as a choice
        }}
      />
      <span aria-hidden="true">{label}</span>
    </label>
  );
}
