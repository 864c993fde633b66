"""Eyes that look and lids that shut."""
