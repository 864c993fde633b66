import type { Job } from '@web/api';

/** A job as the service shows it, with what a test wants to be different. */
export function aJob(differs: Partial<Job> = {}): Job {
  return {
    id: '0198c1d2-7b1a-7c3e-9c6d-0a1b2c3d4e5f',
    kind: 'portrait',
    title: null,
    status: 'running',
    priority: 'normal',
    progress: { stage: null, fraction: 0, message: '', eta_seconds: null },
    queue_position: null,
    inputs: { image: '0198c1d2-7b1a-7c3e-9c6d-000000000001', driver: 'happy' },
    options: {},
    artifacts: {},
    error: null,
    metadata: {},
    created_at: '2025-06-15T12:00:00Z',
    started_at: '2025-06-15T12:00:01Z',
    finished_at: null,
    revision_of: null,
    tree: '0198c1d2-7b1a-7c3e-9c6d-0a1b2c3d4e5f',
    ...differs,
  };
}
