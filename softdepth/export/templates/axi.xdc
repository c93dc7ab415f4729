# {{ name }}: for Vivado. All ports are synchronous to aclk, whose period here is {{ period }} ns: set your clock's.
# In a design whose clock is constrained already, nothing of this is needed: read it for synthesis out of context
# alone (set_property USED_IN {out_of_context synthesis implementation} [get_files {{ name }}.xdc]).
create_clock -name aclk -period {{ period }} [get_ports aclk]
set_input_delay -clock aclk {{ half }} [get_ports {
{%- for port in ports if port.direction == "in" and port.name != "aclk" %}{{ port.name }}{{ "[*]" if port.width > 1 }}{{ "" if loop.last else " " }}{% endfor %}}]
set_output_delay -clock aclk {{ half }} [get_ports {
{%- for port in ports if port.direction == "out" %}{{ port.name }}{{ "[*]" if port.width > 1 }}{{ "" if loop.last else " " }}{% endfor %}}]
