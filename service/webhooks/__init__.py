"""Webhooks: what happens to jobs, told to addresses that users gave (https://www.standardwebhooks.com)."""
