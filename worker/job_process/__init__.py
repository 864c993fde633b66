"""The processes that do the work: kept warm, told what to do, heard, ended."""
