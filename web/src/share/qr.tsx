/** A link as a QR code: whoever points a phone at it opens the link there. Drawn here, so that no other host is told. */

import qrcode from 'qrcode-generator';
import { strings } from '../language/strings';

/** Light modules around the code that readers need. */
const MARGIN = 4;

/** The dark modules of a text's code as one path in a square of `side`, margin included. */
export function qrPath(text: string): { side: number; path: string } {
  const code = qrcode(0, 'M'); // as small as the text allows; 15% of it may be unreadable
  code.addData(text);
  code.make();
  const count = code.getModuleCount();
  let path = '';
  for (let row = 0; row < count; row++) {
    for (let column = 0; column < count; column++) {
      if (code.isDark(row, column)) path += `M${column + MARGIN} ${row + MARGIN}h1v1h-1z`;
    }
  }
  return { side: count + 2 * MARGIN, path };
}

export default function QrCode({ text }: { text: string }) {
  const { side, path } = qrPath(text);
  return (
    <svg class="qr" viewBox={`0 0 ${side} ${side}`} width="148" height="148" role="img" aria-label={strings.share.qr}>
      <rect width={side} height={side} fill="#fff" />
      <path class="solid" d={path} fill="#000" />
    </svg>
  );
}
