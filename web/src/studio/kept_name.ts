/** The name under which something is kept, of what was typed for it: the service says what else is wrong with it. */
export const keptName = (typed: string): string => typed.trim().toLowerCase().replace(/\s+/g, '-');
