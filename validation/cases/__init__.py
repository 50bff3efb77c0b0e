"""One module per case; docs/validation.md describes each."""
