/** What a character's face can do: units on sliders, mixtures of them, and the mouths of speech. */

import { useEffect, useRef, useState } from 'preact/hooks';
import { Box3, Vector3 } from 'three';
import { placeOf } from '../posing/inverse_kinematics';
import type { Character } from '../scene/character';
import type { Stage } from '../scene/stage';
import { words as viewerWords } from '../words';
import { type Expression, groups, type MixtureName, mixtures, type UnitGroup, unitWords, visemes, visemeTarget } from './units';
import './expressions.css';

const words = viewerWords.face;
/** Metres around the middle of a head that a close-up shows. */
const AROUND_HEAD = 0.17;
/** How far above the joint of the head its middle is, metres. */
const ABOVE_JOINT = 0.08;

interface Props {
  stage: Stage;
  character: Character;
}

export default function ExpressionPanel({ stage, character }: Props) {
  const [weights, setWeights] = useState<Expression>({});
  const near = useRef(!character.stands); // a face alone is looked at from close by from the first
  useEffect(() => () => character.face.set({}), [character]);

  const closeUp = (): void => {
    const head = character.joints.get('Head');
    if (!head) return;
    near.current = true;
    const middle = placeOf(head).add(new Vector3(0, ABOVE_JOINT, 0));
    stage.frame(new Box3().setFromCenterAndSize(middle, new Vector3(1, 1, 1).multiplyScalar(2 * AROUND_HEAD)));
  };
  const show = (wanted: Expression): void => {
    if (!near.current) closeUp(); // from afar there is nothing to be seen of it
    setWeights(wanted);
    character.face.set(wanted);
    stage.invalidate();
  };
  const set = (unit: string, weight: number): void => {
    const { [unit]: _before, ...others } = weights;
    show(weight === 0 ? others : { ...others, [unit]: weight });
  };
  const has = (unit: string): boolean => character.face.names.includes(unit);
  const spoken = visemes.filter((viseme) => has(visemeTarget(viseme)));
  return (
    <section class="expressions" aria-label={words.title}>
      <header>
        <h2>{words.title}</h2>
        <div class="actions">
          {character.stands && (
            <button type="button" class="toggle" onClick={closeUp}>
              {words.closeUp}
            </button>
          )}
          <button type="button" class="toggle" disabled={Object.keys(weights).length === 0} onClick={() => show({})}>
            {words.reset}
          </button>
        </div>
      </header>
      <div class="expression-buttons" role="group" aria-label={words.mixtures}>
        {(Object.keys(mixtures) as MixtureName[]).map((name) => (
          <Choice key={name} label={words.mixtureNames[name]} on={same(weights, mixtures[name])} onChoose={() => show(mixtures[name])} />
        ))}
      </div>
      {spoken.length > 0 && (
        <>
          <h3>{words.visemes}</h3>
          <div class="expression-buttons" role="group" aria-label={words.visemes}>
            {spoken.map((viseme) => (
              <Choice
                key={viseme}
                label={viseme}
                name={words.viseme(viseme)}
                on={same(weights, { [visemeTarget(viseme)]: 1 })}
                onChoose={() => show({ [visemeTarget(viseme)]: 1 })}
              />
            ))}
          </div>
        </>
      )}
      {(Object.keys(groups) as UnitGroup[]).map((group, place) => (
        <details key={group} open={place === 0}>
          <summary>{words.groups[group]}</summary>
          {groups[group].filter(has).map((unit) => (
            <UnitSlider key={unit} unit={unit} value={weights[unit] ?? 0} onChange={(weight) => set(unit, weight)} />
          ))}
        </details>
      ))}
    </section>
  );
}

const same = (one: Expression, other: Expression): boolean => {
  const names = new Set([...Object.keys(one), ...Object.keys(other)]);
  return [...names].every((name) => (one[name] ?? 0) === (other[name] ?? 0));
};

interface ChoiceProps {
  label: string;
  /** As it is heard, where the label is too short to be understood. */
  name?: string;
  on: boolean;
  onChoose: () => void;
}

function Choice({ label, name, on, onChoose }: ChoiceProps) {
  return (
    <button type="button" class="toggle" aria-pressed={on} aria-label={name} onClick={onChoose}>
      {label}
    </button>
  );
}

function UnitSlider({ unit, value, onChange }: { unit: string; value: number; onChange: (value: number) => void }) {
  const { name, side } = unitWords(unit);
  const label = side === 'Left' ? words.left(name) : side === 'Right' ? words.right(name) : name;
  return (
    <label class="unit" title={unit}>
      <span>{label}</span>
      <output>{value > 0 ? words.percent(value) : ''}</output>
      <input
        type="range"
        min="0"
        max="1"
        step="0.05"
        value={value}
        aria-label={label}
        aria-valuetext={words.percent(value)}
        onInput={({ currentTarget }) => onChange(currentTarget.valueAsNumber)}
      />
    </label>
  );
}
