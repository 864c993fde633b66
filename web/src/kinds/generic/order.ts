/** An order of any kind: its inputs as files or names, and the options that were set. */

import type { JobRequest } from '../../api';
import { randomKey } from '../../api/idempotency';
import { fileTitle } from '../../language/format';
import { plain } from '../../language/strings';
import type { Order, OrderNames, Upload } from '../../kind/kind';

/** Of an input: files at hand, or the name of something that the service keeps. */
export type Given = readonly File[] | string;

export interface GenericOrder extends Order {
  inputs: Record<string, Given>;
  /** Inputs that take several files. */
  many: readonly string[];
  options: Record<string, unknown>;
}

export const genericOrder = (
  kind: string,
  inputs: Record<string, Given>,
  many: readonly string[],
  options: Record<string, unknown>,
): GenericOrder => ({ kind, key: randomKey(), sent: {}, inputs, many, options });

export function namesOf({ kind, inputs }: GenericOrder): OrderNames {
  const given = Object.values(inputs);
  const [file] = given.flatMap((one) => (typeof one === 'string' ? [] : one));
  const named = given.find((one) => typeof one === 'string');
  return { picture: file ? fileTitle(file) : plain(kind), performance: named ? plain(named) : '' };
}

export async function request(order: GenericOrder, upload: Upload): Promise<JobRequest> {
  const inputs: JobRequest['inputs'] = {};
  for (const [name, given] of Object.entries(order.inputs)) {
    if (typeof given === 'string') {
      inputs[name] = given;
      continue;
    }
    const ids: string[] = [];
    for (const [index, file] of given.entries()) ids.push(await upload(file, index ? `${name} ${index + 1}` : name));
    inputs[name] = order.many.includes(name) ? ids : ids[0]!;
  }
  const { picture, performance } = namesOf(order);
  return { inputs, options: order.options, metadata: { picture, ...(performance && { performance }) } };
}
