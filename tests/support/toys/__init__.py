"""An operator and a criterion of one's own, two modules each."""
