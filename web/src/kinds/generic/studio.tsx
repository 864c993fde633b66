/** Where a job of any kind is ordered: its inputs and options as the service describes them. */

import type { KindDescription } from '../../api';
import { useSending } from '../../sending/use_sending';
import { plain, strings } from '../../language/strings';
import { useDraft } from '../../studio/draft';
import { StudioForm, useStudioTitle } from '../../studio/form';
import { useDescriptions } from '../../kind/offered';
import { useRefusals } from '../../studio/refusals';
import { RecentWorks } from '../../works/recent_works';
import type { Kind, StudioProps } from '../../kind/kind';
import { OptionFields, type Options } from './fields';
import { InputField } from './input';
import { genericOrder, type Given } from './order';
import { fieldsOf } from './schema';

const words = strings.generic;

interface Draft {
  inputs: Readonly<Record<string, Given>>;
  options: Options;
}

const EMPTY_DRAFT: Draft = { inputs: {}, options: {} };

export default function GenericStudio({ kind }: StudioProps) {
  const descriptions = useDescriptions();
  const description = descriptions?.find(({ name }) => name === kind.name);
  useStudioTitle(kind);
  if (!descriptions) return <div aria-busy="true" />;
  return (
    <>
      {description ? <Form kind={kind} description={description} /> : <p>{words.notOffered}</p>}
      <RecentWorks />
    </>
  );
}

function Form({ kind, description }: { kind: Kind; description: KindDescription }) {
  const [{ inputs, options }, change] = useDraft(kind.name, EMPTY_DRAFT);
  const sending = useSending();
  const required = (description.inputs_schema.required ?? []) as string[];
  const absent = required.find((name) => inputs[name] === undefined);
  const { refused, refuse, accept } = useRefusals(kind.name);
  const give = (name: string, given: (before: Given | undefined) => Given | undefined): void => {
    accept(name);
    change(({ inputs: { [name]: before, ...others } }) => {
      const value = given(before);
      return { inputs: value === undefined ? others : { ...others, [name]: value } };
    });
  };
  const many = description.inputs.filter((input) => input.many).map(({ name }) => name);
  const order = () => genericOrder(kind.name, inputs, many, options);
  const fields = fieldsOf(description.options_schema);
  return (
    <StudioForm
      kind={kind}
      title={kind.label}
      lead={description.summary}
      sending={sending}
      missing={absent === undefined ? '' : words.required(plain(absent))}
      order={absent === undefined ? order : null}
      label={words.start}
    >
      {description.inputs.map((input) => (
        <InputField
          key={input.name}
          input={input}
          value={inputs[input.name]}
          onChange={(given) => give(input.name, given)}
          refused={refused[input.name] === true}
          onRefused={() => {
            if (!input.many) give(input.name, () => undefined); // nothing of before is made in its stead
            refuse(input.name);
          }}
        />
      ))}
      {fields.length > 0 && (
        <section class="panel" aria-label={words.options}>
          <details class="choices">
            <summary>{words.options}</summary>
            <div class="fields paired">
              <OptionFields fields={fields} value={options} onChange={(options) => change({ options })} />
            </div>
          </details>
        </section>
      )}
    </StudioForm>
  );
}
