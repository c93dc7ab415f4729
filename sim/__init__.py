"""Running gateware: Verilator builds, cocotb drivers and monitors, seeded stalls."""
