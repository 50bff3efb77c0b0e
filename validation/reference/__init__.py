"""Independent references: hand formulas and small NumPy codes that share nothing with Sinew."""
