/** An input of a job: a file, several, or the name of something that the service keeps. */

import { type InputDescription, listDrivers, listMotions } from '../../api';
import { useLoaded } from '../../api/loading';
import { isMotion, isPicture, isVideo, motionTypes, pictureTypes, videoTypes } from '../../studio/given_files/media_types';
import { plain, strings } from '../../language/strings';
import { FileList } from '../../studio/given_files/file_list';
import { Dropzone } from '../../widgets/dropzone';
import { SelectField } from '../../widgets/select';
import type { Given } from './order';

const words = strings.generic;

const media: Record<string, { accept: string; accepts: (file: File) => Promise<boolean> }> = {
  image: { accept: pictureTypes, accepts: isPicture },
  video: { accept: videoTypes, accepts: isVideo },
  motion: { accept: motionTypes, accepts: isMotion },
};
const anything = { accept: '', accepts: async () => true };

interface Props {
  input: InputDescription;
  value: Given | undefined;
  /** What is given now, of what was given before. */
  onChange: (given: (before: Given | undefined) => Given | undefined) => void;
  /** The file that was given last cannot be taken. */
  refused: boolean;
  onRefused: () => void;
}

export function InputField({ input, value, onChange, refused, onRefused }: Props) {
  const label = plain(input.name);
  const files = filesOf(value);
  const last = input.many ? undefined : files[0];
  return (
    <section class="panel" aria-label={label}>
      <h2>{label}</h2>
      <p class="hint">{input.description}</p>
      {input.library && (
        <LibraryField library={input.library} value={typeof value === 'string' ? value : undefined} onChange={(name) => onChange(() => name)} />
      )}
      {input.many && (
        <FileList
          files={files}
          removeWord={words.removeWord}
          removeLabel={words.remove}
          onRemove={(file) => onChange((before) => without(filesOf(before), file))}
        />
      )}
      <Dropzone
        media={input.media === 'image' || input.media === 'video' ? input.media : 'motion'}
        file={last ?? null}
        {...(media[input.media] ?? anything)}
        words={{
          drop: input.many && files.length ? words.more : (words.file[input.media] ?? words.otherFile),
          browse: words.browse,
          chosen: (name) => words.chosen(label, name),
          wrong: words.wrong,
        }}
        onFile={(file) => onChange((before) => (input.many ? [...filesOf(before), file] : [file]))}
        refused={refused}
        onRefused={onRefused}
      />
    </section>
  );
}

const filesOf = (given: Given | undefined): readonly File[] => (typeof given === 'object' ? given : []);

function without(files: readonly File[], file: File): Given | undefined {
  const others = files.filter((one) => one !== file);
  return others.length ? others : undefined;
}

const AUTO = 'auto';

interface LibraryProps {
  library: string;
  value: string | undefined;
  onChange: (name: string | undefined) => void;
}

function LibraryField({ library, value, onChange }: LibraryProps) {
  const named = useLoaded((signal) => namesIn(library, signal), library).value ?? [];
  return (
    <SelectField
      label={words.named}
      value={value}
      choices={[undefined, ...named]}
      nameOf={(name) => (name === undefined ? words.none : name === AUTO ? words.auto : plain(name))}
      onChange={onChange}
    />
  );
}

/** What an input may name, by the library that it takes names of. */
async function namesIn(library: string, signal: AbortSignal): Promise<string[]> {
  if (library === 'performances') return [AUTO, ...(await listDrivers(signal)).map(({ name }) => name)];
  if (library === 'motions') return (await listMotions(signal)).map(({ name }) => name);
  return [];
}
