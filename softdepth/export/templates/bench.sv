// {{ name }}: a bench to copy; configuration {{ config.name }}, hash {{ config.hash }}; softdepth {{ version }}
//
// Reads and writes registers, sends {{ count }} frames of {{ frames.width }}x{{ frames.height }}, the second with pauses on both sides, and compares each word
// that comes out with that of the fixed-point model. In the folder of {{ name }}.v:
//
//   $ iverilog -g2012 -o bench {{ name }}.v {{ name }}_bench.sv && vvp -n bench
//   $ verilator --binary {{ name }}.v {{ name }}_bench.sv --top-module {{ name }}_bench && obj_dir/V{{ name }}_bench

module {{ name }}_bench;
  localparam WIDTH = {{ frames.width }}, HEIGHT = {{ frames.height }}, FRAMES = {{ count }};
  localparam PIXELS = WIDTH * HEIGHT * FRAMES;
  localparam PATIENCE = {{ patience }};  // clocks without a word after which something is wrong
  localparam QUIET = 1000;  // clocks after the last one in which none may come
  localparam SHOWN = 10;  // differences that are printed

{% for port in ports %}
  {{ "reg" if port.direction == "in" else "wire" }} {% if port.width > 1 %}[{{ port.width - 1 }}:0] {% endif %}{{ port.name }}{{ " = 0" if port.direction == "in" }};
{% endfor %}
  {{ name }} dut (
{% for port in ports %}
    .{{ port.name }}({{ port.name }}){{ "" if loop.last else "," }}
{% endfor %}
  );

  always #5 aclk = ~aclk;
{% for stream in streams if stream.clock != "aclk" %}
  initial #{{ loop.index }} forever #5 {{ stream.clock }} = ~{{ stream.clock }};
{% endfor %}

  integer clock = 0, busy = 0, wrong = 0;
  reg going = 0;
  reg [15:0] noise = 16'hACE1;
  always @(posedge aclk) begin
    clock <= clock + 1;
    noise <= {noise[14:0], noise[15] ^ noise[13] ^ noise[12] ^ noise[10]};
    if (!going) busy <= clock;
    else if (clock - busy > PATIENCE) begin
      $display("FAIL: no word for %0d clocks; %0d of %0d came", PATIENCE, came, PIXELS);
      $fatal(1);
    end
  end

  // What is sent: {tlast, tuser, tdata}.
  reg [{{ bits.s_axis + 1 }}:0] pixels [0:PIXELS-1];
{% for stream in streams %}
  integer {{ stream.prefix }}_offered = 0;
  always @(posedge {{ stream.clock }}) if (going && (!{{ stream.prefix }}_tvalid || {{ stream.prefix }}_tready)) begin
    {{ stream.prefix }}_tvalid <= 0;
    if ({{ stream.prefix }}_offered < PIXELS && !({{ stream.prefix }}_offered >= WIDTH * HEIGHT && noise[{{ loop.index + 1 }}])) begin
      {{ stream.prefix }}_tvalid <= 1;
      {{ stream.prefix }}_tdata <= pixels[{{ stream.prefix }}_offered][{{ stream.low }} +: {{ stream.width }}];
      {{ stream.prefix }}_tuser <= pixels[{{ stream.prefix }}_offered][{{ bits.s_axis }}];
      {{ stream.prefix }}_tlast <= pixels[{{ stream.prefix }}_offered][{{ bits.s_axis + 1 }}];
      {{ stream.prefix }}_offered <= {{ stream.prefix }}_offered + 1;
    end
  end
{% endfor %}

  // What must come back.
  reg [{{ bits.m_axis + 1 }}:0] results [0:PIXELS-1];
  wire [{{ bits.m_axis + 1 }}:0] word = {m_axis_tlast, m_axis_tuser, m_axis_tdata};
  integer came = 0;
  always @(posedge aclk) if (going) begin
    m_axis_tready <= !(came >= WIDTH * HEIGHT && noise[5]);
{% for stream in streams %}
    if ({{ stream.prefix }}_tvalid && {{ stream.prefix }}_tready) busy <= clock;
{% endfor %}
    if (m_axis_tvalid && m_axis_tready) begin
      busy <= clock;
      came <= came + 1;
      if (came >= PIXELS || word !== results[came]) begin
        wrong <= wrong + 1;
        if (wrong < SHOWN)
          $display("frame %0d, y %0d, x %0d: {tlast, tuser, tdata} is %h, not %h", came / (WIDTH * HEIGHT),
                   came / WIDTH % HEIGHT, came % WIDTH, word, results[came % PIXELS]);
      end
    end
  end

  // What follows acts at falling edges, so that everything stands when the clock rises.
  integer bad = 0;
  task tick;
    begin
      @(negedge aclk);
      #1;
    end
  endtask

{% if bus == "axi-lite" %}
  task write_register(input [{{ bits.address - 1 }}:0] address, input [31:0] value);
    begin
      s_axil_awaddr = address;
      s_axil_wdata = value;
      s_axil_wstrb = 4'b1111;
      s_axil_awvalid = 1;
      s_axil_wvalid = 1;
      s_axil_bready = 1;
      #1;
      while (!(s_axil_awready && s_axil_wready)) tick;
      tick;
      s_axil_awvalid = 0;
      s_axil_wvalid = 0;
      while (!s_axil_bvalid) tick;
      tick;
      s_axil_bready = 0;
    end
  endtask

  task check_register(input [{{ bits.address - 1 }}:0] address, input [31:0] value);
    begin
      s_axil_araddr = address;
      s_axil_arvalid = 1;
      s_axil_rready = 1;
      #1;
      while (!s_axil_arready) tick;
      tick;
      s_axil_arvalid = 0;
      while (!s_axil_rvalid) tick;
      compare(address, s_axil_rdata, value);
      tick;
      s_axil_rready = 0;
    end
  endtask
{% else %}
  task access(input [{{ bits.address - 1 }}:0] address);
    begin
      wb_adr = address[{{ bits.address - 1 }}:2];
      wb_sel = 4'b1111;
      wb_cyc = 1;
      wb_stb = 1;
      #1;
      while (!wb_ack) tick;
    end
  endtask

  task write_register(input [{{ bits.address - 1 }}:0] address, input [31:0] value);
    begin
      wb_we = 1;
      wb_dat_w = value;
      access(address);
      tick;
      wb_we = 0;
      wb_cyc = 0;
      wb_stb = 0;
    end
  endtask

  task check_register(input [{{ bits.address - 1 }}:0] address, input [31:0] value);
    begin
      access(address);
      compare(address, wb_dat_r, value);
      tick;
      wb_cyc = 0;
      wb_stb = 0;
    end
  endtask
{% endif %}

  task compare(input [{{ bits.address - 1 }}:0] address, input [31:0] found, input [31:0] value);
    if (found !== value) begin
      $display("register %h is %h, not %h", address, found, value);
      bad = bad + 1;
    end
  endtask

  initial begin
    $readmemh("{{ name }}_bench_in.hex", pixels);
    $readmemh("{{ name }}_bench_out.hex", results);
    repeat (4) tick;
    aresetn = 1;
    tick;
{% for step in before %}
    {{ step.task }}_register('h{{ "%02X" | format(step.address) }}, 'h{{ "%08X" | format(step.value) }});  // {{ step.register }}: {{ step.meaning }}
{% endfor %}
    going = 1;
    while (came < PIXELS) tick;
    repeat (QUIET) tick;
    if (irq !== 1'b1) begin
      $display("irq is %b after a frame", irq);
      bad = bad + 1;
    end
{% for step in after %}
    {{ step.task }}_register('h{{ "%02X" | format(step.address) }}, 'h{{ "%08X" | format(step.value) }});  // {{ step.register }}: {{ step.meaning }}
{% endfor %}
    if (wrong + bad != 0) begin
      $display("FAIL: %0d differences", wrong + bad);
      $fatal(1);
    end
    $display("PASS: %0d words equal the model's, in %0d clocks", came, clock);
    $finish;
  end
endmodule
