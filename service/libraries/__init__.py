"""What users keep under names beside what is built in, and what inspections found in it."""
