"""The `galatea` command."""
