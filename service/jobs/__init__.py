"""Jobs as clients and workers change them: submitted, revised, leased, canceled, deleted."""
