"""The fuzzy cost: memberships, rules and operators."""
