/**
 * No browser test reads its page once and holds what it read against what is to be there: what is drawn a moment later would
 * fail it on a busy machine. `expect.poll(() => …)` reads until it is so; and that something is *not* there is asked by
 * `lacks`, which waits first for what tells that the page is drawn.
 */

import { readdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import ts from 'typescript';
import { describe, expect, it } from 'vitest';

/** What Playwright answers at once, with what a page is just then. */
const READS = new Set([
  ...['all', 'allInnerTexts', 'allTextContents', 'boundingBox', 'content', 'count', 'evaluate', 'evaluateAll', 'getAttribute'],
  ...['innerHTML', 'innerText', 'inputValue', 'isChecked', 'isDisabled', 'isEditable', 'isEnabled', 'isHidden', 'isVisible'],
  ...['screenshot', 'textContent', 'title', 'url'],
]);

const folder = resolve(import.meta.dirname, '../browser');
const files = readdirSync(folder).filter((name) => /\.tsx?$/.test(name));

function* within(node: ts.Node): Generator<ts.Node> {
  yield node;
  for (const child of node.getChildren()) yield* within(child);
}

/** Whether a page is read here: by Playwright itself, or by one of the functions that do so. */
function isRead(node: ts.Node, readers: ReadonlySet<string>): boolean {
  if (!ts.isCallExpression(node)) return false;
  const { expression } = node;
  return ts.isPropertyAccessExpression(expression) ? READS.has(expression.name.text) : readers.has(expression.getText());
}

const reads = (node: ts.Node, readers: ReadonlySet<string>): boolean =>
  [...within(node)].some((part) => isRead(part, readers));

/** Names of the functions that answer with what they read; those of other files that are read for them are `known`. */
function readersOf(file: ts.SourceFile, known: ReadonlySet<string>): Set<string> {
  const readers = new Set(known);
  const functions = [...within(file)].flatMap((node): [string, ts.ConciseBody][] => {
    if (ts.isFunctionDeclaration(node) && node.name && node.body) return [[node.name.text, node.body]];
    const made = ts.isVariableDeclaration(node) && node.initializer;
    return made && ts.isArrowFunction(made) ? [[node.name.getText(), made.body]] : [];
  });
  for (let before = -1; before !== readers.size; ) {
    before = readers.size;
    for (const [name, body] of functions) if (answersOf(body).some((answer) => reads(answer, readers))) readers.add(name);
  }
  return readers;
}

const answersOf = (body: ts.ConciseBody): ts.Node[] =>
  ts.isBlock(body) ? [...within(body)].filter((node) => ts.isReturnStatement(node)) : [body];

/** What a file expects of what is read once, and what it counts none of by itself. */
function hasty(text: string, known: ReadonlySet<string> = new Set()): string[] {
  const file = ts.createSourceFile('a.ts', text, ts.ScriptTarget.Latest, true);
  const readers = readersOf(file, known);
  return [...within(file)].filter(ts.isCallExpression).flatMap((call) => {
    const [given] = call.arguments;
    const once = call.expression.getText() === 'expect' && given && reads(given, readers);
    const none = /^expect(\.poll)?\([^]*(\.count\(\)[^]*\.toBe\(0|\.isVisible\(\)[^]*\.toBe\(false)\)$/.test(call.getText());
    return once || none ? [`line ${file.getLineAndCharacterOfPosition(call.getStart()).line + 1}: ${call.getText()}`] : [];
  });
}

const textOf = (name: string): string => readFileSync(join(folder, name), 'utf8');
const kits = files.filter((name) => !name.includes('.test.'));
const shared = new Set(kits.flatMap((name) => [...readersOf(ts.createSourceFile(name, textOf(name), ts.ScriptTarget.Latest, true), new Set())]));

describe('a browser test', () => {
  it.each(files.filter((name) => name !== 'lacks.ts'))('reads until it is so: %s', (name) => {
    expect(hasty(textOf(name), shared)).toEqual([]);
  });

  it.each([
    'expect(await links.allInnerTexts()).toEqual([]);',
    'expect(Number(await slider.inputValue()), "seconds").toBe(1);',
    'expect(page.url()).toBe("#/");',
    'const at = (page) => page.evaluate(() => scrollY); const twice = async (page) => { return 2 * (await at(page)); }; expect(await twice(page)).toBe(0);',
    'await expect.poll(() => links.count()).toBe(0);',
    'await expect.poll(() => link.isVisible()).toBe(false);',
  ])('is told where it does not: %s', (text) => {
    expect(hasty(text)).toHaveLength(1);
  });

  it.each([
    'await expect.poll(() => links.allInnerTexts()).toEqual([]);',
    'await expect.poll(async () => (await links.count()) + 1).toBe(2);',
    'await lacks(links, heading);',
    'expect(await names("drivers")).toEqual([]);',
    'expect((await response.json()).count).toBe(0);',
  ])('may say: %s', (text) => {
    expect(hasty(text)).toEqual([]);
  });
});
