"""The fuzzy cost: criteria to a fraction."""
