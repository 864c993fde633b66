"""The endpoints of keys: making, listing and revoking them, and erasing what belongs to one."""
