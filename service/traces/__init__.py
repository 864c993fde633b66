"""Requests and jobs followed through all processes: their ids in the logs, and traces, if switched on."""
