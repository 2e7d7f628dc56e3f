"""Scripts that a peer's own Python runs: settings in (JSON), a series and what it cost out (JSON)."""
