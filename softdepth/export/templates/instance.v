// {{ name }}: configuration {{ config.name }}, hash {{ config.hash }}; softdepth {{ version }}
{{ name }} {{ name }}_i (
{% for port in ports %}
  .{{ port.name }}({{ port.name }}){{ "" if loop.last else "," }}  // {{ port.direction }}, {{ port.width }}
{% endfor %}
);
