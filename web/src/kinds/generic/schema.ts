/** The fields of a form, from the JSON Schema of an object. */

import { plain } from '../../language/strings';

type Schema = Readonly<Record<string, unknown>>;
type Value = string | number | boolean;

export type Field = {
  name: string;
  label: string;
  /** What the schema says of it; empty where it says nothing. */
  hint: string;
  /** What holds where nothing is said; null where that is found by the service. */
  usual: unknown;
} & (
  | { type: 'switch' }
  | { type: 'number'; whole: boolean; min: number | null; max: number | null }
  | { type: 'choice'; choices: readonly Value[] }
  /** Any number of these. */
  | { type: 'several'; choices: readonly Value[] }
  | { type: 'text' }
  /** What no other field can hold. */
  | { type: 'json' }
);

export function fieldsOf(schema: Schema): Field[] {
  const properties = (schema.properties ?? {}) as Record<string, Schema>;
  return Object.entries(properties).map(([name, property]) => {
    const [one, nullable] = resolved(property, schema);
    const { description, default: usual = null } = { ...one, ...property };
    return { name, label: plain(name), hint: textIn(description), usual, ...typeOf(one, nullable, schema) } as Field;
  });
}

const textIn = (value: unknown): string => (typeof value === 'string' ? value.replace(/\s+/g, ' ') : '');

/** A schema without references and without the null that it may allow; and whether it does. */
function resolved(schema: Schema, root: Schema): [Schema, nullable: boolean] {
  if (typeof schema.$ref === 'string') return resolved(definition(schema.$ref, root), root);
  const options = (schema.anyOf ?? schema.oneOf ?? schema.allOf) as Schema[] | undefined;
  if (!options) return [schema, false];
  const others = options.filter(({ type }) => type !== 'null');
  const nullable = others.length < options.length;
  if (others.length !== 1) return [{ anyOf: others.map((one) => resolved(one, root)[0]) }, nullable];
  return [resolved(others[0]!, root)[0], nullable];
}

const definition = (reference: string, root: Schema): Schema =>
  reference
    .replace(/^#\//, '')
    .split('/')
    .reduce<Schema>((part, name) => (part[name] ?? {}) as Schema, root);

function typeOf(schema: Schema, nullable: boolean, root: Schema): object {
  const choices = choicesOf(schema);
  if (choices) return { type: 'choice', choices };
  switch (schema.type) {
    case 'boolean':
      return nullable ? { type: 'choice', choices: [true, false] } : { type: 'switch' };
    case 'integer':
    case 'number':
      return {
        type: 'number',
        whole: schema.type === 'integer',
        min: numberIn(schema.minimum ?? schema.exclusiveMinimum),
        max: numberIn(schema.maximum ?? schema.exclusiveMaximum),
      };
    case 'string':
      return { type: 'text' };
    case 'array': {
      const each = schema.items ? choicesOf(resolved(schema.items as Schema, root)[0]) : null;
      return each ? { type: 'several', choices: each } : { type: 'json' };
    }
    default:
      return { type: 'json' };
  }
}

const numberIn = (value: unknown): number | null => (typeof value === 'number' ? value : null);

/** What a schema lets be chosen from; null where that is no list. */
function choicesOf(schema: Schema): readonly Value[] | null {
  if (Array.isArray(schema.enum)) return schema.enum as Value[];
  if (schema.const !== undefined) return [schema.const as Value];
  return null;
}
