"""Measurements that write the documents."""
