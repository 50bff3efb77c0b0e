"""Independent references: closed forms and small NumPy codes that share nothing with Sinew."""
