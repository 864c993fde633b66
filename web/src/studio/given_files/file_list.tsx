/** Files that were chosen, each with a button that takes it away again. */

interface Props {
  files: readonly File[];
  /** What the button says, and what to those who hear it: the same word first. */
  removeWord: string;
  removeLabel: (name: string) => string;
  onRemove: (file: File) => void;
}

export function FileList({ files, removeWord, removeLabel, onRemove }: Props) {
  if (!files.length) return null;
  return (
    <ul class="plain">
      {files.map((file, index) => (
        <li key={index}>
          {file.name}{' '}
          <button type="button" class="button quiet" aria-label={removeLabel(file.name)} onClick={() => onRemove(file)}>
            {removeWord}
          </button>
        </li>
      ))}
    </ul>
  );
}
