# {{ name }}: set the period, in nanoseconds, to your clock's. All ports are synchronous to aclk.
set period 10.000
create_clock -name aclk -period $period [get_ports aclk]
set_input_delay  -clock aclk [expr {0.5 * $period}] [get_ports {
{%- for port in ports if port.direction == "in" and port.name != "aclk" %}{{ port.name }}{{ "*" if port.width > 1 }}{{ "" if loop.last else " " }}{% endfor %}}]
set_output_delay -clock aclk [expr {0.5 * $period}] [get_ports {
{%- for port in ports if port.direction == "out" %}{{ port.name }}{{ "*" if port.width > 1 }}{{ "" if loop.last else " " }}{% endfor %}}]
