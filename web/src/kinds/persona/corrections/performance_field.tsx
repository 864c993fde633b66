/** What a persona plays: as before, another performance, or another video. */

import { useState } from 'preact/hooks';
import type { Job } from '../../../api';
import { useKind } from '../../../kind/kinds';
import type { Performance } from '../../../performances/performance';
import { PerformancePicker } from '../../../performances/performance_picker';
import { useDrivers } from '../../../performances/use_drivers';
import { LoadingProblem } from '../../../widgets/problem_alert';
import { words as personaWords } from '../words';

const words = personaWords.correct;

interface Props {
  job: Job;
  value: Performance | 'held';
  sending: boolean;
  onChange: (performance: Performance | 'held') => void;
}

export function PerformanceField({ job, value, sending, onChange }: Props) {
  const drivers = useDrivers();
  const [refused, setRefused] = useState(false);
  const before = useKind(job.kind).performance(job);
  const choose = (performance: Performance | 'held'): void => {
    setRefused(false);
    onChange(performance);
  };
  return (
    <>
      <p class="hint">{value === 'held' ? words.performanceKept(before ?? personaWords.noPerformance) : ''}</p>
      <LoadingProblem of={drivers} />
      <PerformancePicker
        drivers={drivers.value ?? []}
        chosen={value === 'held' ? null : value}
        onChoose={choose}
        refused={refused}
        onRefused={() => {
          setRefused(true);
          onChange('held');
        }}
        sending={sending}
        pictures
        onKeeping={() => undefined}
        onKept={drivers.reload}
        onGone={() => choose('held')}
      />
      {value !== 'held' && (
        <button type="button" class="button quiet" onClick={() => choose('held')}>
          {words.performanceBack}
        </button>
      )}
    </>
  );
}
