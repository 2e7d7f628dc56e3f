"""Where runs are kept: records, their identity, checksums, locks, checkpoints, provenance."""
