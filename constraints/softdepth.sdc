# Timing constraints of an exported core (`softdepth export`), for flows that read SDC.
#
# Set the period to your clock's. The core has one clock; both streams and `rst` are synchronous to it.
# Inputs are registered or go through a few gates before a register: half the period is a fair budget
# for logic around the core that is in the same clock.

set period 10.000

create_clock -name clk -period $period [get_ports clk]

set_input_delay  -clock clk [expr {0.5 * $period}] [get_ports {rst i_valid i_payload* o_ready}]
set_output_delay -clock clk [expr {0.5 * $period}] [get_ports {i_ready o_valid o_payload* status*}]
