/** Drawn from the OpenAPI document of the service by `npm run client`: not to be edited. */

export interface paths {
    "/v1/files": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Create File
         * @description Upload one file. It is erased after a while if no job uses it.
         */
        post: operations["create_file"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/files/{file_id}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get File
         * @description What is known of a file.
         */
        get: operations["get_file"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/files/{file_id}/content": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get File Content
         * @description The file itself: whole, or the ranges asked for.
         */
        get: operations["get_file_content"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/uploads": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Create Upload
         * @description Begin an upload, with its first piece if one is sent along. Once all of it has come, it is the file with its id;
         *     before that, it is erased when nothing more comes for a while.
         */
        post: operations["create_upload"];
        delete?: never;
        /**
         * Describe Uploads
         * @description What of the tus protocol is offered.
         */
        options: operations["describe_uploads"];
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/uploads/{upload_id}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Upload
         * @description An upload: how much of it has come, and the file that it became. Disturbs nobody, unlike HEAD.
         */
        get: operations["get_upload"];
        put?: never;
        post?: never;
        /**
         * End Upload
         * @description End an upload and erase what came of it. A file that it became goes too, unless a job or a driver uses it.
         */
        delete: operations["end_upload"];
        options?: never;
        /**
         * Resume Upload
         * @description Where to go on. Whatever request is still at the upload is ended, so that the answer holds.
         */
        head: operations["resume_upload"];
        /**
         * Add To Upload
         * @description Add a piece, which begins where the upload stands. What came of it before the line broke is kept, unless it has
         *     a checksum to meet. The last piece makes the upload a file.
         */
        patch: operations["add_to_upload"];
        trace?: never;
    };
    "/v1/jobs": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Jobs
         * @description Jobs, newest first.
         */
        get: operations["list_jobs"];
        put?: never;
        /**
         * Create Job
         * @description Submit a job. The same `Idempotency-Key` with the same request makes one job, however often it is sent.
         */
        post: operations["create_job"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/jobs/{job_id}/revisions": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Revisions
         * @description The job, what it revises, and all that revises it.
         */
        get: operations["list_revisions"];
        put?: never;
        /**
         * Revise Job
         * @description Submit a job again with corrections or other options: only what depends on them is worked out anew.
         */
        post: operations["revise_job"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/jobs/{job_id}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Job
         * @description A job.
         */
        get: operations["get_job"];
        put?: never;
        post?: never;
        /**
         * Delete Job
         * @description Erase a job: its record, its artifacts, and its input files that nothing else uses.
         */
        delete: operations["delete_job"];
        options?: never;
        head?: never;
        /**
         * Change Job
         * @description Give the work that a job is a version of a title, or take it away: all versions have the same.
         */
        patch: operations["change_job"];
        trace?: never;
    };
    "/v1/jobs/{job_id}/cancel": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Cancel Job
         * @description Cancel a job that has not ended.
         */
        post: operations["cancel_job"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/jobs/{job_id}/events": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Follow Job
         * @description The job's events from the beginning, or after `Last-Event-ID`; the stream ends after the final one.
         */
        get: operations["follow_job"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/jobs/{job_id}/artifacts/{name}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Artifact
         * @description An artifact: whole, or the ranges asked for; unchanged ones are answered with 304.
         */
        get: operations["get_artifact"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/jobs/{job_id}/archive": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Archive
         * @description All artifacts of a job that has ended, as one zip.
         */
        get: operations["get_archive"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/kinds": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Kinds
         * @description The job kinds, with the JSON schemas of their inputs and options.
         */
        get: operations["list_kinds"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/drivers": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Drivers
         * @description The drivers that a job can name: the built-in performances, then the user's own.
         */
        get: operations["list_drivers"];
        put?: never;
        /**
         * Create Driver
         * @description Keep a driving video under a name.
         */
        post: operations["create_driver"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/drivers/{name}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Driver
         * @description What is known of a driver.
         */
        get: operations["get_driver"];
        put?: never;
        post?: never;
        /**
         * Delete Driver
         * @description Erase one of the user's own drivers. Jobs that use it keep its video until they are deleted.
         */
        delete: operations["delete_driver"];
        options?: never;
        head?: never;
        /**
         * Rename Driver
         * @description Give one of the user's own drivers another name. Jobs that use it stay as they are.
         */
        patch: operations["rename_driver"];
        trace?: never;
    };
    "/v1/drivers/{name}/moments": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Search Driver
         * @description Search one of the user's own drivers for moments again. A new driver is searched by itself.
         */
        post: operations["search_driver"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/drivers/{name}/video": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Driver Video
         * @description The video itself: whole, or the ranges asked for.
         */
        get: operations["get_driver_video"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/drivers/{name}/poster": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Driver Poster
         * @description A small picture (JPEG) that shows what happens in it; of one's own drivers, the face at rest.
         */
        get: operations["get_driver_poster"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/drivers/{name}/moments/{moment}/poster": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Moment Poster
         * @description A small picture (JPEG) of a moment at its height.
         */
        get: operations["get_moment_poster"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/motions": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Motions
         * @description The motions that a character's job can name: the built-in ones, then the user's own.
         */
        get: operations["list_motions"];
        put?: never;
        /**
         * Create Motion
         * @description Keep a motion under a name. A job checks then what is in it.
         */
        post: operations["create_motion"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/motions/{name}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Motion
         * @description What is known of a motion.
         */
        get: operations["get_motion"];
        put?: never;
        post?: never;
        /**
         * Delete Motion
         * @description Erase one of the user's own motions. Jobs that use it keep its file until they are deleted.
         */
        delete: operations["delete_motion"];
        options?: never;
        head?: never;
        /**
         * Rename Motion
         * @description Give one of the user's own motions another name. Jobs that use it stay as they are.
         */
        patch: operations["rename_motion"];
        trace?: never;
    };
    "/v1/motions/{name}/check": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Check Motion
         * @description Check one of the user's own motions again. A new motion is checked by itself.
         */
        post: operations["check_motion"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/motions/{name}/file": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Motion File
         * @description The file of one of the user's own motions: whole, or the ranges asked for.
         */
        get: operations["get_motion_file"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/key": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Own Key
         * @description The key that the request came with: what it may do, its limits, and how much of them is used.
         */
        get: operations["get_own_key"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/keys": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Keys
         * @description All keys, revoked ones too, without their tokens.
         */
        get: operations["list_keys"];
        put?: never;
        /**
         * Create Key
         * @description Make a key. Its token is in this answer and nowhere else.
         */
        post: operations["create_key"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/keys/{key_id}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Key
         * @description A key without its token.
         */
        get: operations["get_key"];
        put?: never;
        post?: never;
        /**
         * Revoke Key
         * @description Revoke a key; with `erase`, also erase all that belongs to it.
         */
        delete: operations["revoke_key"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/session": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Open Session
         * @description Give a key once; a cookie that scripts cannot read stands for it then (for the web page).
         */
        post: operations["open_session"];
        /**
         * Close Session
         * @description Forget the key in this browser.
         */
        delete: operations["close_session"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/jobs/{job_id}/links": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Links
         * @description The public links to a job.
         */
        get: operations["list_links"];
        put?: never;
        /**
         * Create Link
         * @description Make the results of a job public, under an address that cannot be guessed, for a while or until it is revoked.
         */
        post: operations["create_link"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/links": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List All Links
         * @description The public links to all jobs, newest first: one's own, or with the scope `admin` those of every key.
         */
        get: operations["list_all_links"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/links/{link_id}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        post?: never;
        /**
         * Revoke Link
         * @description Take a public link back: one's own, or with the scope `admin` anybody's.
         */
        delete: operations["revoke_link"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/public/{token}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Shared
         * @description What a public link opens.
         */
        get: operations["get_shared"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/public/{token}/{name}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Shared Artifact
         * @description An artifact that a public link opens: whole, or the ranges asked for.
         */
        get: operations["get_shared_artifact"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/webhooks": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Webhooks
         * @description All endpoints.
         */
        get: operations["list_webhooks"];
        put?: never;
        /**
         * Create Webhook
         * @description Have an address told of jobs. The answer carries the secret that signs the messages.
         */
        post: operations["create_webhook"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/webhooks/deliveries": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Deliveries
         * @description Deliveries to endpoints and to addresses that jobs named themselves, newest first.
         */
        get: operations["list_deliveries"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/webhooks/deliveries/{delivery_id}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Delivery
         * @description A delivery with what it says, and every attempt at it.
         */
        get: operations["get_delivery"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/webhooks/deliveries/{delivery_id}/replay": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Replay Delivery
         * @description Send a message again, now, under its old `webhook-id`.
         */
        post: operations["replay_delivery"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/webhooks/{webhook_id}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Webhook
         * @description An endpoint.
         */
        get: operations["get_webhook"];
        put?: never;
        post?: never;
        /**
         * Delete Webhook
         * @description Erase an endpoint with its deliveries.
         */
        delete: operations["delete_webhook"];
        options?: never;
        head?: never;
        /**
         * Change Webhook
         * @description Change an endpoint; enabling it again takes up what was still to be delivered.
         */
        patch: operations["change_webhook"];
        trace?: never;
    };
    "/v1/webhooks/{webhook_id}/secret": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Webhook Secret
         * @description The secrets that sign for an endpoint.
         */
        get: operations["get_webhook_secret"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/webhooks/{webhook_id}/secret/rotate": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Rotate Webhook Secret
         * @description Give an endpoint a new secret. For a while, messages carry a signature by each of the two.
         */
        post: operations["rotate_webhook_secret"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/webhooks/{webhook_id}/test": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Test Webhook
         * @description Send an endpoint a message of the type `webhook.test`.
         */
        post: operations["test_webhook"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/live": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Create Live
         * @description Begin a live portrait: a picture that follows a camera. Its frames are then sent by the WebSocket at `stream`.
         */
        post: operations["create_live"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/v1/live/{live_id}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Live
         * @description How a live portrait is; for half a minute after its end, why it ended.
         */
        get: operations["get_live"];
        put?: never;
        post?: never;
        /**
         * End Live
         * @description End a live portrait.
         */
        delete: operations["end_live"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/healthz": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Healthz
         * @description The process lives.
         */
        get: operations["healthz"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/readyz": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Readyz
         * @description What the service needs is there.
         */
        get: operations["readyz"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/metrics": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Metrics
         * @description Figures for Prometheus.
         */
        get: operations["metrics"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
}
export type webhooks = Record<string, never>;
export interface components {
    schemas: {
        /** @description A published artifact. */
        ArtifactOut: {
            url: string;
            signed_url?: string | null;
            size: number;
            sha256: string;
            content_type: string;
        };
        /** @description One attempt. */
        AttemptOut: {
            /** Format: date-time */
            started_at: string;
            seconds: number;
            response_status: number | null;
            response_excerpt: string;
            error: components["schemas"]["DeliveryError"] | null;
        };
        /** @description A message for one address, with what it says and all attempts, oldest first. */
        DeliveryDetail: {
            id: string;
            webhook_id: string | null;
            job_id: string | null;
            event: components["schemas"]["EventType"] | "webhook.test";
            url: string;
            status: components["schemas"]["DeliveryStatus"];
            /** Format: date-time */
            created_at: string;
            next_attempt_at: string | null;
            delivered_at: string | null;
            attempts: number;
            last_attempt: components["schemas"]["AttemptOut"] | null;
            data: {
                [key: string]: unknown;
            };
            history: components["schemas"]["AttemptOut"][];
        };
        /** @description Why an attempt failed. */
        DeliveryError: {
            code: string;
            detail: string;
        };
        /** @description A message for one address. */
        DeliveryOut: {
            id: string;
            webhook_id: string | null;
            job_id: string | null;
            event: components["schemas"]["EventType"] | "webhook.test";
            url: string;
            status: components["schemas"]["DeliveryStatus"];
            /** Format: date-time */
            created_at: string;
            next_attempt_at: string | null;
            delivered_at: string | null;
            attempts: number;
            last_attempt: components["schemas"]["AttemptOut"] | null;
        };
        /** @description Deliveries, newest first. */
        DeliveryPage: {
            items: components["schemas"]["DeliveryOut"][];
            next_cursor: string | null;
        };
        /**
         * @description Where a delivery stands.
         * @enum {string}
         */
        DeliveryStatus: "pending" | "delivered" | "failed";
        /** @description Why an endpoint takes no messages. */
        Disabled: {
            /** @enum {string} */
            code: "gone" | "failing" | "by_owner";
            at: string | null;
        };
        /** @description All drivers: the built-in ones first. */
        DriverList: {
            items: components["schemas"]["DriverOut"][];
        };
        /** @description A driving video that a job can name. */
        DriverOut: {
            name: string;
            /** @enum {string} */
            source: "built-in" | "own";
            url: string;
            poster?: string | null;
            title?: string | null;
            state?: ("idle" | "happy" | "surprise" | "anger" | "fear" | "sadness" | "nod" | "shake" | "wink" | "talk") | null;
            emotion?: string | null;
            strength?: ("normal" | "strong") | null;
            seconds?: number | null;
            loops?: boolean | null;
            size?: number | null;
            content_type?: string | null;
            created_at?: string | null;
            /** @default [] */
            moments?: components["schemas"]["MomentOut"][];
            /**
             * @default none
             * @enum {string}
             */
            moments_status?: "none" | "pending" | "ready" | "failed";
            moments_job?: string | null;
        };
        /**
         * @description What can be told of a job.
         * @enum {string}
         */
        EventType: "job.succeeded" | "job.failed" | "job.canceled" | "job.progress";
        /** @description An uploaded file. */
        FileOut: {
            id: string;
            name: string;
            content_type: string;
            size: number;
            sha256: string;
            /** Format: date-time */
            created_at: string;
        };
        /** @description A named input. */
        InputOut: {
            name: string;
            media: string;
            description: string;
            required: boolean;
            many: boolean;
            library: string | null;
            trimmed_by: string | null;
            spared_by: string | null;
            spared_by_input: string | null;
            artifact: string | null;
            corrects: boolean;
        };
        /** @description What is to be different about a job. */
        JobChange: {
            title: string | null;
        };
        /** @description Why a job failed. */
        JobError: {
            code: string;
            detail: string;
            /** @default [] */
            correctable?: string[];
            /** @default {} */
            found?: {
                [key: string]: components["schemas"]["JsonValue"];
            };
        };
        /** @description A job. */
        JobOut: {
            id: string;
            kind: string;
            title: string | null;
            status: components["schemas"]["Status"];
            /** @enum {string} */
            priority: "high" | "normal" | "low";
            progress: components["schemas"]["Progress"];
            queue_position: number | null;
            inputs: {
                [key: string]: string | string[];
            };
            options: {
                [key: string]: components["schemas"]["JsonValue"];
            };
            artifacts: {
                [key: string]: components["schemas"]["ArtifactOut"];
            };
            error: components["schemas"]["JobError"] | null;
            metadata: {
                [key: string]: components["schemas"]["JsonValue"];
            };
            /** Format: date-time */
            created_at: string;
            started_at: string | null;
            finished_at: string | null;
            revision_of: string | null;
            tree: string;
        };
        /** @description Jobs, newest first. */
        JobPage: {
            items: components["schemas"]["JobOut"][];
            versions: {
                [key: string]: number;
            };
            next_cursor: string | null;
        };
        /** @description A job and all its revisions, oldest first; `revision_of` says which revises which. */
        JobTree: {
            items: components["schemas"]["JobOut"][];
        };
        JsonValue: unknown;
        /** @description What is to be different about something that is kept. */
        KeptChange: {
            name: string;
        };
        /** @description A key to be made. Limits that are left out are those of the service's settings. */
        KeyIn: {
            name: string;
            /**
             * @default [
             *       "read",
             *       "submit"
             *     ]
             */
            scopes?: ("read" | "submit" | "admin")[];
            expires_in_days?: number | null;
            requests_per_minute?: number | null;
            jobs_at_once?: number | null;
            stored_mb?: number | null;
        };
        /** @description All keys, oldest first. */
        KeyList: {
            items: components["schemas"]["KeyOut"][];
        };
        /** @description A key, as it may be seen by whoever manages keys. */
        KeyOut: {
            id: string;
            name: string;
            hint: string;
            scopes: string[];
            requests_per_minute: number | null;
            jobs_at_once: number | null;
            stored_mb: number | null;
            /** Format: date-time */
            created_at: string;
            expires_at: string | null;
            revoked_at: string | null;
            last_used_at: string | null;
        };
        /** @description The most that a job may take. */
        KindLimits: {
            seconds: number;
            memory_mb: number;
            cores: number | null;
        };
        /** @description All job kinds. */
        KindList: {
            items: components["schemas"]["KindOut"][];
        };
        /** @description A job kind. */
        KindOut: {
            name: string;
            summary: string;
            inputs: components["schemas"]["InputOut"][];
            inputs_schema: {
                [key: string]: unknown;
            };
            options_schema: {
                [key: string]: unknown;
            };
            correctable: string[];
            short: boolean;
            limits: components["schemas"]["KindLimits"];
        };
        /** @description A link to be made. */
        LinkIn: {
            expires_in_hours?: number | null;
            artifacts?: string[] | null;
        };
        /** @description A job's public links, oldest first. */
        LinkList: {
            items: components["schemas"]["LinkOut"][];
        };
        /** @description A public link, as its owner sees it. */
        LinkOut: {
            id: string;
            owner: string;
            job_id: string;
            url: string | null;
            page: string | null;
            hint: string;
            artifacts: string[] | null;
            /** Format: date-time */
            created_at: string;
            expires_at: string | null;
        };
        /** @description Public links, newest first. */
        LinkPage: {
            items: components["schemas"]["LinkOut"][];
            next_cursor: string | null;
        };
        /** @description Which picture is to follow the camera: one of `image` and `job`. */
        LiveIn: {
            image?: string | null;
            job?: string | null;
            /** @default {} */
            options?: {
                [key: string]: components["schemas"]["JsonValue"];
            };
        };
        /** @description A live portrait. */
        LiveOut: {
            id: string;
            /** @enum {string} */
            status: "preparing" | "calibrating" | "live" | "ended";
            stream: string;
            view: string;
            code: string | null;
            detail: string | null;
        };
        /** @description A moment of a driver that holds a state. A job can name it as its driver: `driver/moment`. */
        MomentOut: {
            name: string;
            /** @enum {string} */
            state: "idle" | "happy" | "surprise" | "anger" | "fear" | "sadness" | "nod" | "shake" | "wink" | "talk";
            /** @enum {string} */
            strength: "normal" | "strong";
            start: number;
            end: number;
            seconds: number;
            apex: number;
            score: number;
            url: string;
            poster: string;
        };
        /** @description What is wrong with a motion. */
        MotionError: {
            code: string;
            detail: string;
        };
        /** @description A joint of a motion's skeleton. */
        MotionJoint: {
            name: string;
            parent: string | null;
        };
        /** @description All motions: the built-in ones first. */
        MotionList: {
            items: components["schemas"]["MotionOut"][];
        };
        /** @description A motion that a character's job can name. */
        MotionOut: {
            name: string;
            /** @enum {string} */
            source: "built-in" | "own";
            title?: string | null;
            seconds?: number | null;
            loops?: boolean | null;
            url?: string | null;
            size?: number | null;
            content_type?: string | null;
            created_at?: string | null;
            fps?: number | null;
            frames?: number | null;
            /** @default [] */
            clips?: string[];
            /** @default [] */
            joints?: components["schemas"]["MotionJoint"][];
            /** @default {} */
            mapping?: {
                [key: string]: string;
            };
            /** @default [] */
            missing?: string[];
            error?: components["schemas"]["MotionError"] | null;
            /**
             * @default none
             * @enum {string}
             */
            check_status?: "none" | "pending" | "ready" | "failed";
            check_job?: string | null;
        };
        /** @description A key that was just made. The token is shown this once. */
        NewKeyOut: {
            id: string;
            name: string;
            hint: string;
            scopes: string[];
            requests_per_minute: number | null;
            jobs_at_once: number | null;
            stored_mb: number | null;
            /** Format: date-time */
            created_at: string;
            expires_at: string | null;
            revoked_at: string | null;
            last_used_at: string | null;
            token: string;
        };
        /** @description An endpoint that was just made, with the secret that signs what it is told. */
        NewWebhookOut: {
            id: string;
            url: string;
            events: components["schemas"]["EventType"][];
            description: string;
            enabled: boolean;
            disabled: components["schemas"]["Disabled"] | null;
            failing_since: string | null;
            /** Format: date-time */
            created_at: string;
            secret: string;
        };
        /** @description What a caller may know of the key that it uses. */
        OwnKeyOut: {
            id: string;
            name: string;
            scopes: string[];
            signing_secret: string | null;
            requests_per_minute: number | null;
            jobs_at_once: number | null;
            stored_mb: number | null;
            expires_at: string | null;
            jobs_under_way: number;
            stored_bytes: number;
        };
        /** @description How far a job is. */
        Progress: {
            stage?: string | null;
            /** @default 0 */
            fraction?: number;
            /** @default  */
            message?: string;
            eta_seconds?: number | null;
            /** @default [] */
            stages?: string[];
        };
        /** @description How an endpoint's secret is replaced. */
        RotationIn: {
            /** @default 24 */
            overlap_hours?: number;
        };
        /** @description The secrets that sign for an endpoint. */
        SecretOut: {
            secret: string;
            previous_secret: string | null;
            previous_until: string | null;
        };
        /** @description The key that a session of the web page stands for. */
        SessionIn: {
            key: string;
        };
        /** @description An artifact that a public link opens. */
        SharedArtifactOut: {
            url: string;
            size: number;
            sha256: string;
            content_type: string;
        };
        /** @description What a public link opens. */
        SharedOut: {
            kind: string;
            title: string | null;
            has_sound: boolean | null;
            finished_at: string | null;
            expires_at: string | null;
            artifacts: {
                [key: string]: components["schemas"]["SharedArtifactOut"];
            };
        };
        /**
         * @description Where a job stands.
         * @enum {string}
         */
        Status: "queued" | "running" | "succeeded" | "failed" | "canceled";
        /** @description A resumable upload. */
        UploadOut: {
            id: string;
            /** @enum {string} */
            status: "receiving" | "finished";
            name: string;
            offset: number;
            length: number | null;
            /** Format: date-time */
            created_at: string;
            expires_at: string | null;
            file: components["schemas"]["FileOut"] | null;
        };
        /** @description What is to be different about an endpoint; what is left out stays. */
        WebhookChange: {
            url?: string | null;
            events?: components["schemas"]["EventType"][] | null;
            description?: string | null;
            enabled?: boolean | null;
        };
        /** @description An endpoint to be told of jobs. */
        WebhookIn: {
            url: string;
            /**
             * @default [
             *       "job.succeeded",
             *       "job.failed",
             *       "job.canceled"
             *     ]
             */
            events?: components["schemas"]["EventType"][];
            /** @default  */
            description?: string;
            /** @default true */
            enabled?: boolean;
        };
        /** @description All endpoints, oldest first. */
        WebhookList: {
            items: components["schemas"]["WebhookOut"][];
        };
        /** @description An endpoint. */
        WebhookOut: {
            id: string;
            url: string;
            events: components["schemas"]["EventType"][];
            description: string;
            enabled: boolean;
            disabled: components["schemas"]["Disabled"] | null;
            failing_since: string | null;
            /** Format: date-time */
            created_at: string;
        };
        /** @description Options of the avatar system; every one has a sound default. */
        AvatarOptions: {
            /**
             * @description How tall the person is, metres. Without it the size is guessed from how people are built, and the report says so.
             * @default null
             * @example 1.75
             */
            height_m?: number | null;
            /**
             * @description Frames that are taken from the clip of the body.
             * @default 75
             */
            body_frames?: number;
            /**
             * @description Frames that are taken from the clip of the head.
             * @default 50
             */
            head_frames?: number;
            /**
             * @description Frames that are taken from each further clip.
             * @default 25
             */
            more_frames?: number;
            /**
             * @description Width and height of the texture in pixels.
             * @default 4096
             * @enum {integer}
             */
            texture_size?: 1024 | 2048 | 4096 | 8192;
            /**
             * @description Most triangles of the avatar.
             * @default 33676
             */
            triangles?: number;
            /**
             * @description Further levels of detail, each with a quarter of the triangles, in the same GLB (MSFT_lod).
             * @default 0
             */
            levels?: number;
            /**
             * @description Whether geometry and animations of the GLB are compressed (EXT_meshopt_compression): half as large, for programs that read it.
             * @default none
             * @enum {string}
             */
            compression?: "none" | "meshopt";
            /**
             * @description Write the avatar as VRM 1.0, too.
             * @default false
             */
            vrm?: boolean;
            /**
             * @description Whose the avatar is, as its VRM file says: nobody else may use it without asking.
             * @default Galatea
             */
            vrm_author?: string;
            /**
             * @description The lens of the body's clip, where it is known; otherwise it is found.
             * @default null
             * @example {
             *       "centre": [
             *         539.5,
             *         959.5
             *       ],
             *       "focal": 1580.5,
             *       "k1": 0.012
             *     }
             */
            body_lens?: components["schemas"]["KnownLens"] | null;
            /**
             * @description The same of the head's clip.
             * @default null
             */
            head_lens?: components["schemas"]["KnownLens"] | null;
            /**
             * @description Frames of the body's clip, by their numbers in the report's `inputs`, of which nothing is made.
             * @default []
             */
            body_frames_left_out?: number[];
            /**
             * @description The same of the head's clip.
             * @default []
             */
            head_frames_left_out?: number[];
            /**
             * @description Landmarks of the body (MediaPipe's names, such as `LeftElbow`) where they are not found well, in two frames or more that show them from different sides. The person's own left and right.
             * @default {}
             * @example {
             *       "LeftElbow": [
             *         {
             *           "frame": 120,
             *           "place": [
             *             402,
             *             611
             *           ]
             *         },
             *         {
             *           "frame": 480,
             *           "place": [
             *             231,
             *             598
             *           ]
             *         }
             *       ]
             *     }
             */
            landmarks?: {
                [key: string]: components["schemas"]["PlacedLandmark"][];
            };
            /**
             * @description The clip that the video shows, where no file is given.
             * @default idle
             * @enum {string}
             */
            motion?: "idle" | "walk" | "run" | "jump" | "sit" | "wave" | "dance" | "bow";
            /**
             * @description The joints of the motion's file that move the character's where they are not found by themselves: {"Hips": "pelvis"}. null leaves one out.
             * @default {}
             */
            motion_joints?: {
                [key: string]: string | null;
            };
            /**
             * @description Which of a GLB's animations is played, by its name; by default the first in which something moves.
             * @default null
             */
            motion_clip?: string | null;
            /**
             * @description Width and height of the videos in pixels.
             * @default [
             *       720,
             *       1280
             *     ]
             * @example [
             *       720,
             *       1280
             *     ]
             */
            size?: [
                number,
                number
            ];
            /**
             * @description Frames a second of clips and videos.
             * @default 30
             */
            fps?: number;
            /**
             * @description Length of the animation: a longer motion is cut, and of a shorter one the last pose is held.
             * @default 4
             */
            seconds?: number;
        };
        /** @description Options of the character system; every one has a sound default. */
        CharacterOptions: {
            /**
             * @description The clip into which the person steps, where no file is given.
             * @default walk
             * @enum {string}
             */
            motion?: "idle" | "walk" | "run" | "jump" | "sit" | "wave" | "dance" | "bow";
            /**
             * @description The joints of the motion's file that move the character's where they are not found by themselves: {"Hips": "pelvis"}. null leaves one out.
             * @default {}
             */
            motion_joints?: {
                [key: string]: string | null;
            };
            /**
             * @description Which of a GLB's animations is played, by its name; by default the first in which something moves.
             * @default null
             */
            motion_clip?: string | null;
            /**
             * @description Parts of the body that stay as pictured.
             * @default []
             */
            keep?: ("head" | "torso" | "left_arm" | "right_arm" | "left_leg" | "right_leg" | "arms" | "legs")[];
            /**
             * @description Length of the video: a longer motion is cut, and of a shorter one the last pose is held.
             * @default 4
             */
            seconds?: number;
            /**
             * @description Width and height of the video in pixels; the picture is fitted into it. Default: the picture's own size, the longest side at most 1280.
             * @default null
             * @example [
             *       300,
             *       300
             *     ]
             */
            size?: [
                number,
                number
            ] | null;
            /**
             * @description Frames a second of clips and video.
             * @default 30
             */
            fps?: number;
            /**
             * @description Container of the animation; png is a zip of numbered pictures. A gif has 256 colours and, without `size`, 640 pixels on the longest side.
             * @default mp4
             * @enum {string}
             */
            format?: "mp4" | "webm" | "webp" | "gif" | "png";
            /**
             * @description What the video's camera does.
             * @default fixed
             * @enum {string}
             */
            camera?: "fixed" | "orbit" | "parallax";
            /**
             * @description Most triangles of the character.
             * @default 60000
             */
            triangles?: number;
            /**
             * @description Further levels of detail, each with a quarter of the triangles: character-lod1.glb and so on.
             * @default 0
             */
            levels?: number;
            /**
             * @description Write the character as VRM 1.0, too.
             * @default false
             */
            vrm?: boolean;
            /**
             * @description Whose the character is, as its VRM file says: nobody else may use it without asking.
             * @default Galatea
             */
            vrm_author?: string;
            /**
             * @description Draw the character under lamps, too: lit.png. Takes OpenGL, which not every machine has.
             * @default false
             */
            lit?: boolean;
            /**
             * @description Accept a person who is cut off or hidden below the chest, and animate what is there.
             * @default false
             */
            partial?: boolean;
            /**
             * @description Joints turned on from the pictured pose, by their names in the character's skeleton: degrees about x, y and z of the T-pose. The person starts from there, and posed.png shows it.
             * @default {}
             */
            pose?: {
                [key: string]: [
                    number,
                    number,
                    number
                ];
            };
            /**
             * @description Joints placed by hand, by their names in skeleton.json: [x, y] in pixels of the picture.
             * @default {}
             */
            joints?: {
                [key: string]: [
                    number,
                    number
                ];
            };
            /**
             * @description x, y, width and height in pixels of the picture: the person is looked for in there, whatever person_index says.
             * @default null
             * @example [
             *       120,
             *       40,
             *       200,
             *       560
             *     ]
             */
            person_box?: [
                number,
                number,
                number,
                number
            ] | null;
            /**
             * @description Which of the people in the picture, the largest first (the report lists them), or “all”: each becomes a character, and all walk out together. Default: the largest, unless there is a crowd.
             * @default null
             */
            person_index?: number | "all" | null;
            /**
             * @description Strokes over the mask, in their order.
             * @default []
             */
            mask_strokes?: components["schemas"]["MaskStroke"][];
            /**
             * @description Strokes over the label map, in their order.
             * @default []
             */
            label_strokes?: components["schemas"]["LabelStroke"][];
            /**
             * @description The back: plain cloth as the sides of the trunk have it at each height, without what only fronts have (ties, prints, pockets, collars); a mirrored copy of the front; or filled by what the sides of each part of the body show.
             * @default see_through
             * @enum {string}
             */
            back_texture?: "see_through" | "mirror" | "inpaint";
            /**
             * @description What the character is made of. relief: the picture cut into parts that are given their depth, the paper's way. shell: the human template displaced to the outline, whole from every side and where parts touch. hybrid: trunk and hanging cloth of the relief, arms and legs of the shell, and its head where hair keeps to it. auto: the hybrid; where an arm is raised and no leg passes before the other, the relief with such a head.
             * @default auto
             * @enum {string}
             */
            surface?: "auto" | "hybrid" | "relief" | "shell";
        };
        /** @description One field that is wrong. */
        FieldError: {
            pointer: string;
            code: string;
            detail: string;
        };
        /** @description What a client asks for. */
        JobIn: {
            /** @enum {string} */
            kind: "portrait" | "moments" | "character" | "avatar" | "persona" | "motion";
            /** @default {} */
            inputs?: {
                [key: string]: string | string[];
            };
            /** @default {} */
            options?: {
                [key: string]: components["schemas"]["JsonValue"];
            };
            /** @default null */
            webhook_url?: string | null;
            /** @default null */
            webhook_events?: components["schemas"]["EventType"][] | null;
            /** @default {} */
            metadata?: {
                [key: string]: components["schemas"]["JsonValue"];
            };
            /**
             * @default normal
             * @enum {string}
             */
            priority?: "high" | "normal" | "low";
            /** @default null */
            title?: string | null;
        };
        /** @description A camera's lens that somebody has calibrated, in pixels of the upright clip: Brown's model, as OpenCV has it. */
        KnownLens: {
            /** @description Focal length. */
            focal: number;
            /**
             * @description The principal point (x, y); without it the middle of the frame.
             * @default null
             */
            centre?: [
                number,
                number
            ] | null;
            /**
             * @description Radial distortion, of the square of the radius.
             * @default 0
             */
            k1?: number;
            /**
             * @description Radial distortion, of its fourth power.
             * @default 0
             */
            k2?: number;
        };
        /** @description A stroke of a round brush over the label map, in pixels of the picture. */
        LabelStroke: {
            /** @description The points that the brush passes. */
            path: [
                number,
                number
            ][];
            radius: number;
            /**
             * @description What it paints; the person's own left and right.
             * @enum {string}
             */
            part: "head" | "torso" | "left_arm" | "right_arm" | "left_leg" | "right_leg";
        };
        /** @description A stroke of a round brush over the mask, in pixels of the picture. */
        MaskStroke: {
            /** @description The points that the brush passes. */
            path: [
                number,
                number
            ][];
            radius: number;
            /** @description Whether it paints the person, or what is not the person. */
            person: boolean;
        };
        /** @description There is nothing to choose: a search finds what there is. */
        MomentsOptions: Record<string, never>;
        /** @description What a user may choose about a check. */
        MotionOptions: {
            /**
             * @description The joints of the motion's file that move the character's where they are not found by themselves: {"Hips": "pelvis"}. null leaves one out.
             * @default {}
             */
            motion_joints?: {
                [key: string]: string | null;
            };
            /**
             * @description Which of a GLB's animations is played, by its name; by default the first in which something moves.
             * @default null
             */
            motion_clip?: string | null;
        };
        /** @description Options of the persona system; every one has a sound default. */
        PersonaOptions: {
            /**
             * @description Pixels of the face's texture. Default: as many as the photos are worth, 194 to 400.
             * @default null
             */
            texture_width?: number | null;
            /**
             * @description Faces to use whatever speaks against them, by their numbers in `faces.json`.
             * @default []
             */
            keep?: number[];
            /**
             * @description Faces not to use, by their numbers in `faces.json`.
             * @default []
             */
            leave_out?: number[];
            /**
             * @description A face of the person that is meant, where photos show several, by its number in `faces.json`.
             * @default null
             */
            example?: number | null;
            /**
             * @description First and last year of the photos to use, of those that say when they were taken.
             * @default null
             */
            years?: [
                number,
                number
            ] | null;
            /**
             * @description Which of the person's looks to use, where the photos show several, of decades say: its number in `faces.json`, 0 is the one that most show. Default: all of them.
             * @default null
             */
            look?: number | null;
            /**
             * @description Width and height of the animation, in pixels; `side_by_side` has the driver beside it, as high as it.
             * @default [
             *       600,
             *       800
             *     ]
             */
            size?: [
                number,
                number
            ];
            /**
             * @description Frames a second of the animation. Default: one frame for each frame of the driver.
             * @default null
             */
            fps?: number | null;
            /**
             * @description Start and end of the part of the driver to use, in seconds.
             * @default null
             */
            trim?: [
                number,
                number
            ] | null;
            /**
             * @description Which face of the driver, counted from the largest in the first frame that shows any.
             * @default 0
             */
            driver_face_index?: number;
            /**
             * @description What is seen: the puppet alone before a plain background or a picture (none), the person as they are in one of the photos (photo), or the puppet beside the driver (side_by_side). By itself (auto) a photo, where one shows half a head and no `background_picture` is given, else the puppet alone.
             * @default auto
             * @enum {string}
             */
            composite?: "auto" | "none" | "photo" | "side_by_side";
            /**
             * @description Whose photo acts, where one does: a face by its number in `faces.json`. Default: the best one.
             * @default null
             */
            photo?: number | null;
            /**
             * @description The light on the face of the film or the still. own: the photo's; the puppet has the mean of all photos. average: that mean. left, right: that of the photos that are lit most from this side of the picture.
             * @default own
             * @enum {string}
             */
            light?: "own" | "average" | "left" | "right";
            /**
             * @description Photos to leave in the light that all have in the mean, as `average_light_N.png`: faces by their numbers in `faces.json`.
             * @default []
             */
            average_light?: number[];
            /**
             * @description Red, green and blue of the plain background, where no `background_picture` is given.
             * @default [
             *       58,
             *       60,
             *       64
             *     ]
             */
            background?: [
                number,
                number,
                number
            ];
            /**
             * @description Keep the driver's sound.
             * @default false
             */
            sound?: boolean;
        };
        /** @description Where a landmark of the body is in one frame of its clip. */
        PlacedLandmark: {
            /** @description Which frame of the clip; one of those in the report's `inputs`. */
            frame: number;
            /** @description Pixel (x, y) of the upright frame. */
            place: [
                number,
                number
            ];
        };
        /** @description Options of the portrait system; every one has a sound default. */
        PortraitOptions: {
            /**
             * @description Width and height of the result in pixels; the target is fitted into it. Default: the target's own size, the longest side at most 1920.
             * @default null
             * @example [
             *       300,
             *       300
             *     ]
             */
            size?: [
                number,
                number
            ] | null;
            /**
             * @description Frames a second of the result. Default: one frame for each frame of the driver.
             * @default null
             */
            fps?: number | null;
            /**
             * @description Container of the animation; png is a zip of numbered pictures. A gif has 256 colours and, without `size`, 640 pixels on the longest side.
             * @default mp4
             * @enum {string}
             */
            format?: "mp4" | "webm" | "webp" | "gif" | "png";
            /**
             * @description Frame on which the driver shows the target's expression, counted from 0 among those that are used: of the `trim`, at the `fps`. Default: found automatically.
             * @default null
             */
            neutral_frame?: number | null;
            /**
             * @description Which face of the target, counted from the largest; with a crop by numbers, of those in the crop.
             * @default 0
             */
            face_index?: number;
            /**
             * @description Which face of the driver, counted from the largest in the first frame that shows any. Not for `auto`, which compares the largest ones.
             * @default 0
             */
            driver_face_index?: number;
            /**
             * @description How strongly the motion is carried over; 1 is as the driver does it.
             * @default 1
             */
            strength?: number;
            /**
             * @description Which parts follow the driver; `["all"]` stands for every one.
             * @default [
             *       "eyes",
             *       "mouth",
             *       "brows",
             *       "head"
             *     ]
             */
            follow?: ("eyes" | "mouth" | "brows" | "head")[];
            /**
             * @description Turn the head by a 3D proxy; false keeps to the paper's warp in the plane.
             * @default true
             */
            head_3d?: boolean;
            /**
             * @description Part of the target to animate: around the face, head and shoulders, or [x, y, width, height] in pixels. Faces are looked for within such a crop, however small they are in the whole.
             * @default none
             * @example bust
             * @example [
             *       10,
             *       20,
             *       300,
             *       400
             *     ]
             */
            crop?: ("none" | "face" | "bust") | [
                number,
                number,
                number,
                number
            ];
            /**
             * @description Start and end of the part of the driver to use, in seconds; the end comes after the start.
             * @default null
             * @example [
             *       0.5,
             *       2
             *     ]
             */
            trim?: [
                number,
                number
            ] | null;
            /**
             * @description Ease the end back into the beginning, so that the result repeats without a jump.
             * @default false
             */
            loop?: boolean;
            /**
             * @description Keep the driver's sound.
             * @default false
             */
            sound?: boolean;
            /**
             * @description Placed landmarks of the target, 68 points [x, y] in pixels of the picture, where no face is detected or detection is off. They say whose face it is: `face_index` does not count beside them.
             * @default null
             */
            landmarks?: [
                number,
                number
            ][] | null;
            /**
             * @description Make a reactive profile, which plays emotions on demand: true, or the built-in performances that are to be its states. A driver is not needed then; one that is given becomes a state of its own.
             * @default false
             */
            reactive?: boolean | string[];
        };
        /** @description What every error answers. */
        ProblemDocument: {
            type: string;
            title: string;
            status: number;
            code: string;
            detail: string;
            /** @default null */
            errors?: components["schemas"]["FieldError"][] | null;
            /** @default null */
            request_id?: string | null;
        };
        /** @description What is to be different. */
        RevisionIn: {
            /** @default {} */
            corrections?: {
                [key: string]: components["schemas"]["JsonValue"];
            };
            /** @default {} */
            options?: {
                [key: string]: components["schemas"]["JsonValue"];
            };
            /** @default null */
            webhook_url?: string | null;
            /** @default null */
            webhook_events?: components["schemas"]["EventType"][] | null;
            /** @default null */
            metadata?: {
                [key: string]: components["schemas"]["JsonValue"];
            } | null;
            /** @default null */
            priority?: ("high" | "normal" | "low") | null;
        };
    };
    responses: never;
    parameters: never;
    requestBodies: never;
    headers: never;
    pathItems: never;
}
export type $defs = Record<string, never>;
export interface operations {
    create_file: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "multipart/form-data": {
                    /** Format: binary */
                    file: string;
                };
            };
        };
        responses: {
            /** @description Successful Response */
            201: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["FileOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unsupported Media Type */
            415: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Insufficient Storage */
            507: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_file: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                file_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["FileOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_file_content: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                file_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description The asked parts */
            206: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Not modified */
            304: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Requested Range Not Satisfiable */
            416: {
                headers: {
                    /** @description How long the file is. */
                    "Content-Range": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    create_upload: {
        parameters: {
            query?: never;
            header: {
                /** @description How long the whole upload is. */
                "upload-length"?: number;
                /** @description 1: the length will be told later. */
                "Upload-Defer-Length"?: number;
                /** @description Keys with values in base64, separated by commas; `filename` and `filetype` are understood. */
                "upload-metadata"?: string;
                /** @description The piece's checksum, `ALGORITHM BASE64`; one of sha1, sha256, crc32. */
                "upload-checksum"?: string;
                /** @description The protocol's version. */
                "Tus-Resumable": "1.0.0";
            };
            path?: never;
            cookie?: never;
        };
        requestBody?: {
            content: {
                "application/offset+octet-stream": string;
            };
        };
        responses: {
            /** @description The upload */
            201: {
                headers: {
                    /** @description The protocol's version. */
                    "Tus-Resumable"?: string;
                    /** @description The upload's address; its last part is the id, and later the file's. */
                    Location?: string;
                    /** @description As many bytes are safely kept. */
                    "Upload-Offset"?: number;
                    /** @description When the upload is erased unless more of it comes. */
                    "Upload-Expires"?: string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["UploadOut"];
                };
            };
            /** @description Bad Request */
            400: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Timeout */
            408: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Gone */
            410: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Precondition Failed */
            412: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unsupported Media Type */
            415: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Locked */
            423: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Checksum Mismatch */
            460: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Service Unavailable */
            503: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Insufficient Storage */
            507: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    describe_uploads: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description What is offered */
            204: {
                headers: {
                    /** @description The protocol's version. */
                    "Tus-Resumable"?: string;
                    /** @description The versions that are spoken. */
                    "Tus-Version"?: string;
                    /** @description The extensions of the protocol that are spoken. */
                    "Tus-Extension"?: string;
                    /** @description The longest upload, in bytes. */
                    "Tus-Max-Size"?: number;
                    /** @description The checksums that are understood. */
                    "Tus-Checksum-Algorithm"?: string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_upload: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                upload_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["UploadOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Gone */
            410: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    end_upload: {
        parameters: {
            query?: never;
            header: {
                /** @description The protocol's version. */
                "Tus-Resumable": "1.0.0";
            };
            path: {
                upload_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Erased */
            204: {
                headers: {
                    /** @description The protocol's version. */
                    "Tus-Resumable"?: string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Bad Request */
            400: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Gone */
            410: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Precondition Failed */
            412: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Locked */
            423: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    resume_upload: {
        parameters: {
            query?: never;
            header: {
                /** @description The protocol's version. */
                "Tus-Resumable": "1.0.0";
            };
            path: {
                upload_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Where the upload stands */
            200: {
                headers: {
                    /** @description The protocol's version. */
                    "Tus-Resumable"?: string;
                    /** @description As many bytes are safely kept. */
                    "Upload-Offset"?: number;
                    /** @description How long the whole upload is. */
                    "Upload-Length"?: number;
                    /** @description 1 as long as the length is not known. */
                    "Upload-Defer-Length"?: number;
                    /** @description As it was sent. */
                    "Upload-Metadata"?: string;
                    /** @description When the upload is erased unless more of it comes. */
                    "Upload-Expires"?: string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Bad Request */
            400: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Gone */
            410: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Precondition Failed */
            412: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Locked */
            423: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    add_to_upload: {
        parameters: {
            query?: never;
            header: {
                /** @description Where the piece begins. */
                "upload-offset": number;
                /** @description How long the whole upload is. */
                "upload-length"?: number;
                /** @description The piece's checksum, `ALGORITHM BASE64`; one of sha1, sha256, crc32. */
                "upload-checksum"?: string;
                /** @description The protocol's version. */
                "Tus-Resumable": "1.0.0";
            };
            path: {
                upload_id: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/offset+octet-stream": string;
            };
        };
        responses: {
            /** @description The piece is kept */
            204: {
                headers: {
                    /** @description The protocol's version. */
                    "Tus-Resumable"?: string;
                    /** @description As many bytes are safely kept. */
                    "Upload-Offset"?: number;
                    /** @description When the upload is erased unless more of it comes. */
                    "Upload-Expires"?: string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Bad Request */
            400: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Timeout */
            408: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Gone */
            410: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Precondition Failed */
            412: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unsupported Media Type */
            415: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Locked */
            423: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Checksum Mismatch */
            460: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Service Unavailable */
            503: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Insufficient Storage */
            507: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    list_jobs: {
        parameters: {
            query?: {
                /** @description One or several. */
                status?: components["schemas"]["Status"][];
                /** @description One or several. */
                kind?: string[];
                created_after?: string;
                created_before?: string;
                /** @description Words of title, kind, and names of files, drivers and motions. */
                q?: string;
                /** @description Of each work one job alone: its newest that the rest lets through. */
                latest?: boolean;
                limit?: number;
                cursor?: string;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobPage"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    create_job: {
        parameters: {
            query?: never;
            header?: {
                "idempotency-key"?: string;
                /** @description `wait=SECONDS` holds the answer until the job ends. */
                prefer?: string;
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["JobIn"];
                "multipart/form-data": {
                    /** @enum {string} */
                    priority?: "high" | "normal" | "low";
                    inputs?: Record<string, never>;
                    options?: Record<string, never>;
                    metadata?: Record<string, never>;
                    webhook_url?: string;
                    webhook_events?: string[] | null;
                    kind: string;
                    title?: string;
                } & {
                    [key: string]: string;
                };
            };
        };
        responses: {
            /** @description Successful Response */
            202: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unsupported Media Type */
            415: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Insufficient Storage */
            507: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    list_revisions: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobTree"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    revise_job: {
        parameters: {
            query?: never;
            header?: {
                "idempotency-key"?: string;
                /** @description `wait=SECONDS` holds the answer until the job ends. */
                prefer?: string;
            };
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["RevisionIn"];
                "multipart/form-data": {
                    /** @enum {string} */
                    priority?: "high" | "normal" | "low";
                    corrections?: Record<string, never>;
                    options?: Record<string, never>;
                    metadata?: Record<string, never> | null;
                    webhook_url?: string;
                    webhook_events?: string[] | null;
                } & {
                    [key: string]: string;
                };
            };
        };
        responses: {
            /** @description Successful Response */
            202: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unsupported Media Type */
            415: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Insufficient Storage */
            507: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_job: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    delete_job: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    change_job: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["JobChange"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    cancel_job: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["JobOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    follow_job: {
        parameters: {
            query?: {
                /** @description The same, for clients that cannot set headers. */
                after?: string;
            };
            header?: {
                /** @description Resume after this event. */
                "last-event-id"?: string;
            };
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Server-sent events: `status`, `progress` and `artifact` */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "text/event-stream": unknown;
                };
            };
            /** @description The final event was already received: do not connect again */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_artifact: {
        parameters: {
            query?: {
                /** @description As in the `signed_url` that a job gives. */
                expires?: string;
                /** @description As in the `signed_url` that a job gives. */
                signature?: string;
            };
            header?: never;
            path: {
                job_id: string;
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description The asked parts */
            206: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Not modified */
            304: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Requested Range Not Satisfiable */
            416: {
                headers: {
                    /** @description How long the file is. */
                    "Content-Range": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_archive: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description A zip */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/zip": unknown;
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    list_kinds: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["KindList"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    list_drivers: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DriverList"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    create_driver: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "multipart/form-data": {
                    name: string;
                    /** Format: binary */
                    file: string;
                };
                "application/json": {
                    name: string;
                    /** @description The id of an uploaded file. */
                    file: string;
                };
            };
        };
        responses: {
            /** @description Successful Response */
            201: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DriverOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unsupported Media Type */
            415: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Insufficient Storage */
            507: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_driver: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DriverOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    delete_driver: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    rename_driver: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["KeptChange"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DriverOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    search_driver: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            202: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DriverOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Insufficient Storage */
            507: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_driver_video: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description The asked parts */
            206: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Not modified */
            304: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Requested Range Not Satisfiable */
            416: {
                headers: {
                    /** @description How long the file is. */
                    "Content-Range": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_driver_poster: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Not modified */
            304: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Requested Range Not Satisfiable */
            416: {
                headers: {
                    /** @description How long the file is. */
                    "Content-Range": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_moment_poster: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
                moment: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Not modified */
            304: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Requested Range Not Satisfiable */
            416: {
                headers: {
                    /** @description How long the file is. */
                    "Content-Range": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    list_motions: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MotionList"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    create_motion: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "multipart/form-data": {
                    name: string;
                    /** Format: binary */
                    file: string;
                };
                "application/json": {
                    name: string;
                    /** @description The id of an uploaded file. */
                    file: string;
                };
            };
        };
        responses: {
            /** @description Successful Response */
            201: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MotionOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unsupported Media Type */
            415: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Insufficient Storage */
            507: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_motion: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MotionOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    delete_motion: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    rename_motion: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["KeptChange"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MotionOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    check_motion: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            202: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MotionOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Insufficient Storage */
            507: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_motion_file: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description The asked parts */
            206: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Not modified */
            304: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Requested Range Not Satisfiable */
            416: {
                headers: {
                    /** @description How long the file is. */
                    "Content-Range": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_own_key: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["OwnKeyOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    list_keys: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["KeyList"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    create_key: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["KeyIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            201: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["NewKeyOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_key: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                key_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["KeyOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    revoke_key: {
        parameters: {
            query?: {
                erase?: boolean;
            };
            header?: never;
            path: {
                key_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    open_session: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["SessionIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    close_session: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
        };
    };
    list_links: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["LinkList"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    create_link: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                job_id: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["LinkIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            201: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["LinkOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    list_all_links: {
        parameters: {
            query?: {
                limit?: number;
                cursor?: string;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["LinkPage"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    revoke_link: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                link_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_shared: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                token: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SharedOut"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_shared_artifact: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                token: string;
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description The asked parts */
            206: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Not modified */
            304: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Requested Range Not Satisfiable */
            416: {
                headers: {
                    /** @description How long the file is. */
                    "Content-Range": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    list_webhooks: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["WebhookList"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    create_webhook: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["WebhookIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            201: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["NewWebhookOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    list_deliveries: {
        parameters: {
            query?: {
                /** @description One or several. */
                status?: components["schemas"]["DeliveryStatus"][];
                /** @description One or several. */
                event?: (components["schemas"]["EventType"] | "webhook.test")[];
                /** @description The id of a job. */
                job?: string;
                /** @description The id of an endpoint. */
                webhook?: string;
                limit?: number;
                cursor?: string;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DeliveryPage"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_delivery: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                delivery_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DeliveryDetail"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    replay_delivery: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                delivery_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            202: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DeliveryOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_webhook: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                webhook_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["WebhookOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    delete_webhook: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                webhook_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    change_webhook: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                webhook_id: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["WebhookChange"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["WebhookOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_webhook_secret: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                webhook_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SecretOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    rotate_webhook_secret: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                webhook_id: string;
            };
            cookie?: never;
        };
        requestBody?: {
            content: {
                "application/json": components["schemas"]["RotationIn"] | null;
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SecretOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    test_webhook: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                webhook_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            202: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DeliveryOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Conflict */
            409: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    create_live: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["LiveIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            201: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["LiveOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Request Entity Too Large */
            413: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Service Unavailable */
            503: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    get_live: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                live_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["LiveOut"];
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    end_live: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                live_id: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Not Found */
            404: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Unprocessable Entity */
            422: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
    healthz: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": {
                        [key: string]: string;
                    };
                };
            };
        };
    };
    readyz: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": unknown;
                };
            };
            /** @description Something that it needs is missing */
            503: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content?: never;
            };
        };
    };
    metrics: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "text/plain": string;
                };
            };
            /** @description Unauthorized */
            401: {
                headers: {
                    /** @description How to authenticate. */
                    "WWW-Authenticate": string;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Forbidden */
            403: {
                headers: {
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
            /** @description Too Many Requests */
            429: {
                headers: {
                    /** @description Seconds. */
                    "Retry-After": number;
                    /** @description The request's id, as in the service's log: the caller's own `X-Request-Id`, if it has this form. */
                    "X-Request-Id": string;
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["ProblemDocument"];
                };
            };
        };
    };
}
