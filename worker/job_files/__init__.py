"""What a job takes in and leaves behind: fetched, copied, judged, published."""
