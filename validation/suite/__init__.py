"""What every validation case stands on: checks and verdicts, scorecard, plots, robots."""
