/** Colours as options have them, red, green and blue up to 255, and as browsers choose them. */

export const hexOf = (colour: readonly number[]): string => `#${colour.map((channel) => channel.toString(16).padStart(2, '0')).join('')}`;

export const colourOf = (hex: string): number[] => [1, 3, 5].map((start) => parseInt(hex.slice(start, start + 2), 16));
