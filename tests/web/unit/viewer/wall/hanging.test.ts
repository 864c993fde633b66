import { hang } from '@web/viewer/wall/hanging';
import { expect, it } from 'vitest';

const camera = {
  eye: [0.1, 1.1, 4.2] as [number, number, number],
  focal: 900,
  centre: [310, 395] as [number, number],
  size: [640, 800] as [number, number],
};

it('hangs a picture where its camera sees each of its corners at its own pixel', () => {
  const { eye, plane, left, right, top, bottom, lift } = hang(camera);
  const pixel = (x: number, y: number) => [
    (camera.focal * (x - eye[0])) / (eye[2] - plane) + camera.centre[0],
    (-camera.focal * (y - eye[1])) / (eye[2] - plane) + camera.centre[1],
  ];
  // pixels have their places in their middles: a picture reaches half a pixel beyond the outermost
  const corners = [...pixel(left, top), ...pixel(right, bottom)];
  [-0.5, -0.5, 639.5, 799.5].forEach((value, index) => expect(corners[index]).toBeCloseTo(value, 9));
  expect(eye[1] - lift, 'the eye is as high above the ground of the picture as before').toBeCloseTo(1.1, 12);
  expect(bottom, 'the picture hangs above the floor').toBeGreaterThan(0.1);
});

it('lifts no picture that hangs high enough by itself', () => {
  expect(hang({ ...camera, eye: [0, 9, 4.2] }).lift).toBe(0);
});
