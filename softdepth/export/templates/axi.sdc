# {{ name }}: set the period, in nanoseconds, to your clock's.{% if clocks | length == 1 %} All ports are synchronous to aclk.{% else %} Each stream of a view is synchronous
# to its own clock, all else to aclk. What passes between them are Gray codes and a reset.{% endif %}

set period 10.000
{% for clock in clocks %}
create_clock -name {{ clock.name }} -period $period [get_ports {{ clock.name }}]
{% endfor %}
{% if clocks | length > 1 %}
set_clock_groups -asynchronous{% for clock in clocks %} -group {{ clock.name }}{% endfor %}

{% endif %}
{% for clock in clocks %}
{% for way, names in (("input", clock.inputs), ("output", clock.outputs)) %}
set_{{ way }}_delay {{ " " if way == "input" }}-clock {{ clock.name }} [expr {0.5 * $period}] [get_ports { {{- names | join(" ") -}} }]
{% endfor %}
{% endfor %}
