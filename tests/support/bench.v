// Streams pixel pairs into an exported core and prints what leaves it: a bench that knows the ports alone.
// It says T and a clock for each pixel taken, R, a clock and the payload for each result, X for an unknown bit.
`timescale 1ns / 1ps
module bench;
  reg clk = 1'b0;
  reg rst = 1'b1;
  reg [`I_BITS-1:0] i_payload = 0;
  reg i_valid = 1'b0;
  reg o_ready = 1'b0;
  wire i_ready, o_valid;
  wire [`O_BITS-1:0] o_payload;
  wire [`STATUS_BITS-1:0] status;
  softdepth_core dut (
    .clk(clk), .rst(rst), .i_payload(i_payload), .i_valid(i_valid), .i_ready(i_ready),
    .o_payload(o_payload), .o_valid(o_valid), .o_ready(o_ready), .status(status)
  );

  reg [`I_BITS-1:0] pixels [0:`PIXELS-1];
  integer clock = 0, taken = 0, given = 0, quiet = 0, pause = 0;
  reg [15:0] noise = 16'hACE1;
  initial $readmemh("pixels.hex", pixels);
  always #5 clk = ~clk;

  always @(posedge clk) begin
    clock <= clock + 1;
    quiet <= quiet + 1;
    noise <= {noise[14:0], noise[15] ^ noise[13] ^ noise[12] ^ noise[10]};
    rst <= clock + 1 < `RESET_CLOCKS;
    o_ready <= `STALLS ? noise[0] : 1'b1;
    if (^i_ready === 1'bx || ^o_valid === 1'bx || ^status === 1'bx || (o_valid && ^o_payload === 1'bx))
      $display("X %0d ready %b valid %b payload %b status %h", clock, i_ready, o_valid, o_payload, status);
    if (rst && i_ready) $display("W %0d ready in reset", clock);
    if (o_valid && o_ready && !rst) begin
      $display("R %0d %h", clock, o_payload);
      given = given + 1;
      quiet <= 0;
    end
    if (i_valid && i_ready) begin
      $display("T %0d", clock);
      taken = taken + 1;
      quiet <= 0;
      pause = `GAP;
    end
    if (pause > 0) pause = pause - 1;
    // An offer is made even in reset: it must not be taken then.
    if ((i_valid && !i_ready) || (taken < `PIXELS && pause == 0 && !(`STALLS && noise[3]))) begin
      i_valid <= 1'b1;
      i_payload <= pixels[taken];
    end else i_valid <= 1'b0;
    if (quiet > `PATIENCE) begin
      $display("S %h", status);
      $finish;
    end
  end
endmodule
