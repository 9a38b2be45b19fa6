"""What a run returns, records and writes."""
