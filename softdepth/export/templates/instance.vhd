-- {{ name }}: configuration {{ config.name }}, hash {{ config.hash }}; softdepth {{ version }}
component {{ name }} is
  port (
{% for port in ports %}
    {{ port.name }} : {{ port.direction }} std_logic{% if port.width > 1 %}_vector({{ port.width - 1 }} downto 0){% endif %}{{ "" if loop.last else ";" }}
{% endfor %}
  );
end component;

{{ name }}_i : {{ name }}
  port map (
{% for port in ports %}
    {{ port.name }} => {{ port.name }}{{ "" if loop.last else "," }}
{% endfor %}
  );
