/** A button that asks for a folder; not there where browsers give none. */

interface Props {
  label: string;
  /** All that lies in it, and in folders in it. */
  onFiles: (files: readonly File[]) => void;
}

export function FolderButton({ label, onFiles }: Props) {
  if (!('webkitdirectory' in HTMLInputElement.prototype)) return null;
  return (
    <label class="button file-button">
      <input
        type="file"
        class="visually-hidden"
        ref={(input) => {
          if (input) input.webkitdirectory = true;
        }}
        aria-label={label}
        onChange={({ currentTarget }) => {
          onFiles([...(currentTarget.files ?? [])]);
          currentTarget.value = ''; // so that choosing the same folder again counts as a choice
        }}
      />
      <span aria-hidden="true">{label}</span>
    </label>
  );
}
