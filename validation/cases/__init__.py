"""One module a case; see docs/validation.md for what each holds."""
