import { qrPath } from '@web/share/qr';
import { execFileSync } from 'node:child_process';
import { resolve } from 'node:path';
import { expect, it } from 'vitest';

const python = resolve(import.meta.dirname, '../../../../.venv/bin/python');
const READ = `
import re, sys
import cv2, numpy as np
side, path = int(sys.argv[1]), sys.argv[2]
picture = np.full((side, side), 255, np.uint8)
for x, y in re.findall(r"M(\\d+) (\\d+)", path):
    picture[int(y), int(x)] = 0
print(cv2.QRCodeDetector().detectAndDecode(np.kron(picture, np.ones((8, 8), np.uint8)))[0])
`;

it('draws a code that a reader gives back as the link', () => {
  const link = `https://faces.example/#/shared/${'aZ-_09'.repeat(8)}`;
  const { side, path } = qrPath(link);
  expect(execFileSync(python, ['-c', READ, String(side), path]).toString().trim()).toBe(link);
});
