/** What inputs of a job may be: files, addresses, and names of what the service keeps. */

const fileIdForm = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/;

/** Whether an input is a file that was uploaded. */
export const isFileId = (value: unknown): value is string => typeof value === 'string' && fileIdForm.test(value);

export const isUrl = (value: string): boolean => /^https?:/.test(value);

/** Where an uploaded file plays from. */
export const fileUrl = (id: string): string => `/v1/files/${id}/content`;

/** What is text, and not empty. */
export const textOf = (value: unknown): string | null => (typeof value === 'string' && value !== '' ? value : null);
