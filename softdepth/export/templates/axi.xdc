# {{ name }}: for Vivado. The period here is {{ period }} ns: set your clock's.{% if clocks | length == 1 %} All ports are synchronous to aclk.{% else %} Each stream of a view is
# synchronous to its own clock, all else to aclk. What passes between them are Gray codes and a reset.{% endif %}

# In a design whose clock is constrained already, nothing of this is needed{% if clocks | length > 1 %} but that clocks are asynchronous{% endif %}: read it for synthesis out of context
# alone (set_property USED_IN {out_of_context synthesis implementation} [get_files {{ name }}.xdc]).
{% for clock in clocks %}
create_clock -name {{ clock.name }} -period {{ period }} [get_ports {{ clock.name }}]
{% endfor %}
{% if clocks | length > 1 %}
set_clock_groups -asynchronous{% for clock in clocks %} -group {{ clock.name }}{% endfor %}

{% endif %}
{% for clock in clocks %}
{% for way, names in (("input", clock.inputs), ("output", clock.outputs)) %}
set_{{ way }}_delay -clock {{ clock.name }} {{ half }} [get_ports { {{- names | map("replace", "*", "[*]") | join(" ") -}} }]
{% endfor %}
{% endfor %}
