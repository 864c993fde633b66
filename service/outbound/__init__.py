"""Calls to other hosts whose addresses users gave: webhooks, inputs by address."""
