"""Shared parts of the validation cases: checks and verdicts, scorecard, plots, robots."""
