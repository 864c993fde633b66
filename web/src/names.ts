/** What names stand for in a job: files, addresses, and what the service keeps. */

import { stem } from './format';
import { plain } from './strings';

const fileIdForm = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/;

/** Whether an input is a file that was uploaded. */
export const isFileId = (value: unknown): value is string => typeof value === 'string' && fileIdForm.test(value);

export const isUrl = (value: string): boolean => /^https?:/.test(value);

/** Where an uploaded file plays from. */
export const fileUrl = (id: string): string => `/v1/files/${id}/content`;

/** What is text, and not empty. */
export const textOf = (value: unknown): string | null => (typeof value === 'string' && value !== '' ? value : null);

/** What a file of the visitor's own is called. */
export const fileTitle = (file: File): string => plain(stem(file.name));

/** The name under which something is kept, of what was typed for it: the service says what else is wrong with it. */
export const keptName = (typed: string): string => typed.trim().toLowerCase().replace(/\s+/g, '-');
