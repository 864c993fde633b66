/** What the page knows of a kind of job. Whatever differs from kind to kind is said in the kind's own folder. */

import type { ComponentType, VNode } from 'preact';
import type { Job, JobRequest, Problem, Report, Shared } from '../api';

/** What is wanted. Sent again after a broken line, or by a later page, it neither uploads nor orders anything twice. */
export interface Order {
  kind: string;
  /** Makes the order safe to repeat. */
  key: string;
  /** The ids of the files that have arrived, by what they are to the order. */
  sent: Record<string, string>;
}

/** What an order is called: its picture, and what the picture is to do. */
export interface OrderNames {
  picture: string;
  performance: string;
}

/** Which one of the files that are one part of an order, counted from 1. */
export interface PlaceInPart {
  number: number;
  count: number;
}

/** Sends a file, unless it has arrived before; its id. */
export type Upload = (file: File, part: string, place?: PlaceInPart) => Promise<string>;

/** Options that a result proposes for a revision of its job, such as a pose that was set in the viewer. */
export type Proposal = Readonly<Record<string, unknown>>;

export interface StudioProps {
  kind: Kind;
}

export interface ResultProps {
  job: Job;
  /** What the run says of itself; null where it left none. */
  report: Report | null;
  onPropose: (proposal: Proposal) => void;
}

export interface CorrectionsProps {
  job: Job;
  report: Report | null;
  proposal: Proposal | null;
  onProposalTaken: () => void;
  onProblem: (problem: Problem | null) => void;
}

export interface SharedProps {
  shared: Shared;
  /** Reads what is shared once more, with links that have only now been signed. */
  renew: (signal: AbortSignal) => Promise<Shared>;
  /** The animation, where it has a format that browsers show. */
  film: VNode | undefined;
}

export interface ProgressProps {
  job: Job;
}

/** Fetches a part of the page when it is first needed. */
export type Load<Props> = () => Promise<{ default: ComponentType<Props> }>;

/** Words by the names that engine and service use. */
export type Names = Readonly<Record<string, string>>;

export interface Kind<Wanted extends Order = Order> {
  /** As the service calls it. */
  readonly name: string;
  /** What it is called among the things that can be made. */
  readonly label: string;
  /** The address of its studio. */
  readonly link: string;

  readonly loadStudio: Load<StudioProps>;
  /** What is shown of a job on its way, beside its preview and its stages; null where that is all. */
  readonly loadProgress: Load<ProgressProps> | null;
  readonly loadResult: Load<ResultProps>;
  /** What can be put right before a job is made again; null where the page offers nothing. */
  readonly loadCorrections: Load<CorrectionsProps> | null;
  /** What a public link shows beyond the animation; null where that is all. */
  readonly loadShared: Load<SharedProps> | null;

  readonly stages: Names;
  /** Titles of what can go wrong, by code. */
  readonly failures: Names;
  /** Inputs, options and corrections, as they are named where versions of a work are told apart; in the order of telling. */
  readonly differences: Names;
  /** What a version has of this name, where a word can tell it. */
  valueOf(job: Job, name: string): string | null;

  /** The input that is the picture; null: the first that is a file. */
  readonly pictureInput: string | null;
  /** What its picture is called; null where the client did not say. */
  pictureName(job: Job): string | null;
  /** What the picture acts out or does; null where the client did not say. */
  performance(job: Job): string | null;
  /** A sentence that says what the picture acts out or does. */
  performed(performance: string): string;

  namesOf(order: Wanted): OrderNames;
  /** Sends the files of an order; what to ask for then. */
  request(order: Wanted, upload: Upload): Promise<JobRequest>;

  readonly shared: {
    /** The heading of a work without a title. */
    readonly title: string;
    /** What its animation shows. */
    readonly alt: string;
    /** Whether its animation has sound, where the link does not say. */
    readonly hasSound: boolean;
    /** Files that most people have a use for; all others are listed. */
    readonly downloads: readonly (readonly [file: RegExp, label: string])[];
    /** What a link opens unless it is to open everything. */
    readonly opened: RegExp;
  };
  /** Kinds whose jobs look into a file on behalf of this one: what they find is shown with that file, not as a work. */
  readonly inspections: readonly string[];
  /** Files, by what they are to an order, as they are named while they are sent. */
  readonly files: Names;
  /** How files of its inputs usually end, for examples. */
  readonly endings: Names;
}
