"""Criteria: what a candidate is judged by. One component per kind of criterion."""
