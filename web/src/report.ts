/** What runs of every kind say about themselves; only what this page reads. */

/** x, y, width and height in pixels of the picture. */
export type Frame = [x: number, y: number, width: number, height: number];

/** What a finished run says about itself (report.json); only what this page reads. */
export interface Report {
  warnings: { code: string; message: string }[];
  inputs: {
    fps: number;
    frames: number;
    neutral_frame: number;
    /** The driver that the job took where it was asked to choose. */
    driver_chosen?: string | null;
    /** The faces found in the picture, the largest first: x, y, width and height in pixels of the picture. */
    faces: Frame[];
    /** Likewise those of the performance; earlier versions did not say it. */
    driver_faces?: Frame[];
    /** The people found in the picture of a character, the largest first; and which of them was taken. */
    people?: Frame[];
    person?: number | 'all' | null;
  };
}
