/** The service's HTTP API, as far as this page uses it. */

export { Problem, problemFrom, type Schemas } from './client';
export * from './jobs';
export * from './keys';
export * from './library';
export * from './live';
export * from './links';
export * from './report';
export * from './webhooks';
