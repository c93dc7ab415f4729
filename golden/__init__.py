"""The method in NumPy: the paper in floating point, and the fixed-point model of the gateware."""
