/** Where the performance of an order is chosen: what it is for, the choice, and what of the choice can be set. */

import type { ComponentChildren } from 'preact';
import { useId } from 'preact/hooks';
import type { Driver } from '../api';
import type { Loading } from '../api/loading';
import { LoadingProblem } from '../widgets/problem_alert';
import { PerformancePicker, type PickerProps } from './performance_picker';

interface Props extends Omit<PickerProps, 'drivers' | 'onKept'> {
  title: string;
  hint: string;
  drivers: Loading<Driver[]>;
  wide?: boolean;
  options: ComponentChildren;
}

export function PerformancePanel({ title, hint, drivers, wide = false, options, ...choice }: Props) {
  const id = useId();
  return (
    <section class={wide ? 'panel wide' : 'panel'} aria-labelledby={id}>
      <h2 id={id}>{title}</h2>
      <p class="hint">{hint}</p>
      <LoadingProblem of={drivers} />
      <PerformancePicker drivers={drivers.value ?? []} onKept={drivers.reload} {...choice} />
      {options}
    </section>
  );
}
