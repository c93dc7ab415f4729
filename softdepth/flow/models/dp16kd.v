// ECP5 block RAM of 18 kbit: what the core's memories use of it, after Lattice's "ECP5 and ECP5-5G Memory
// User Guide" (FPGA-TN-02204), sections on true and pseudo dual-port RAM.
//
// Words of 1, 2, 4, 9, 18 or 36 bits, with output registers. An address counts bits: the word is
// AD[13:0], [13:1], [13:2], [13:3], [13:4] or [13:5]; what lies below enables the bytes (of 9 bits) of a
// write of 18 or 36 bits. Words below 9 bits leave the ninth bit of a byte unused. A port of 36 bits takes
// the data pins of both ports, A's for the lower half.
//
// A word that one port writes while the other reads it is undefined by the guide. Here it is read inverted,
// so that a design which relies on either value is found out.
module DP16KD (
  input DIA17, DIA16, DIA15, DIA14, DIA13, DIA12, DIA11, DIA10, DIA9,
  input DIA8, DIA7, DIA6, DIA5, DIA4, DIA3, DIA2, DIA1, DIA0,
  input ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0,
  input CEA, OCEA, CLKA, WEA, RSTA, CSA2, CSA1, CSA0,
  output DOA17, DOA16, DOA15, DOA14, DOA13, DOA12, DOA11, DOA10, DOA9,
  output DOA8, DOA7, DOA6, DOA5, DOA4, DOA3, DOA2, DOA1, DOA0,
  input DIB17, DIB16, DIB15, DIB14, DIB13, DIB12, DIB11, DIB10, DIB9,
  input DIB8, DIB7, DIB6, DIB5, DIB4, DIB3, DIB2, DIB1, DIB0,
  input ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0,
  input CEB, OCEB, CLKB, WEB, RSTB, CSB2, CSB1, CSB0,
  output DOB17, DOB16, DOB15, DOB14, DOB13, DOB12, DOB11, DOB10, DOB9,
  output DOB8, DOB7, DOB6, DOB5, DOB4, DOB3, DOB2, DOB1, DOB0
);
  parameter DATA_WIDTH_A = 18;
  parameter DATA_WIDTH_B = 18;
  parameter REGMODE_A = "NOREG";
  parameter REGMODE_B = "NOREG";
  parameter RESETMODE = "SYNC";
  parameter ASYNC_RESET_RELEASE = "SYNC";
  parameter CSDECODE_A = "0b000";
  parameter CSDECODE_B = "0b000";
  parameter WRITEMODE_A = "NORMAL";
  parameter WRITEMODE_B = "NORMAL";
  parameter CLKAMUX = "CLKA";
  parameter CLKBMUX = "CLKB";
  parameter GSR = "AUTO";

  function is_modelled(input integer width);
    is_modelled = width == 1 || width == 2 || width == 4 || width == 9 || width == 18 || width == 36;
  endfunction

  initial begin
    if (!is_modelled(DATA_WIDTH_A) || !is_modelled(DATA_WIDTH_B)) $fatal(1, "this word width is not modelled");
    if (REGMODE_A != "NOREG" && REGMODE_A != "OUTREG") $fatal(1, "this register mode is not modelled");
    if (REGMODE_B != "NOREG" && REGMODE_B != "OUTREG") $fatal(1, "this register mode is not modelled");
    if ((DATA_WIDTH_A == 36 || DATA_WIDTH_B == 36) && REGMODE_A != REGMODE_B)
      $fatal(1, "an output register for half of a word is not modelled");
    if (WRITEMODE_A != "NORMAL" && WRITEMODE_A != "READBEFOREWRITE") $fatal(1, "this write mode is not modelled");
    if (WRITEMODE_B != "NORMAL" && WRITEMODE_B != "READBEFOREWRITE") $fatal(1, "this write mode is not modelled");
    if (CSDECODE_A != "0b000" || CSDECODE_B != "0b000") $fatal(1, "this chip select is not modelled");
    if (CLKAMUX != "CLKA" || CLKBMUX != "CLKB") $fatal(1, "inverted clocks are not modelled");
  end

  wire [13:0] ada = {ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0};
  wire [13:0] adb = {ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0};
  wire [17:0] dia = {DIA17, DIA16, DIA15, DIA14, DIA13, DIA12, DIA11, DIA10, DIA9,
                     DIA8, DIA7, DIA6, DIA5, DIA4, DIA3, DIA2, DIA1, DIA0};
  wire [17:0] dib = {DIB17, DIB16, DIB15, DIB14, DIB13, DIB12, DIB11, DIB10, DIB9,
                     DIB8, DIB7, DIB6, DIB5, DIB4, DIB3, DIB2, DIB1, DIB0};

  // 512 rows of four bytes, whatever the width of a word.
  reg [35:0] rows [0:511];
  integer row;
  initial for (row = 0; row < 512; row = row + 1) rows[row] = 36'd0;

  // The bytes of a row that a word is made of, and those that a write of it changes.
  function [3:0] bytes_of(input integer width, input [13:0] address);
    case (width)
      36: bytes_of = 4'b1111;
      18: bytes_of = address[4] ? 4'b1100 : 4'b0011;
      default: bytes_of = 4'b0001 << address[4:3];
    endcase
  endfunction

  function [3:0] enabled(input integer width, input [13:0] address);
    case (width)
      36: enabled = address[3:0];
      18: enabled = {address[1:0], address[1:0]};
      default: enabled = 4'b1111;
    endcase
  endfunction

  // A word's data at every place in the row where it could go; a row's data at the lowest place.
  function [35:0] spread(input integer width, input [35:0] word);
    case (width)
      36: spread = word;
      18: spread = {word[17:0], word[17:0]};
      9: spread = {word[8:0], word[8:0], word[8:0], word[8:0]};
      4: spread = {4{1'b0, word[3:0], word[3:0]}};
      2: spread = {4{1'b0, word[1:0], word[1:0], word[1:0], word[1:0]}};
      default: spread = {4{1'b0, {8{word[0]}}}};
    endcase
  endfunction

  function [35:0] gather(input integer width, input [13:0] address, input [35:0] data);
    case (width)
      36: gather = data;
      18: gather = address[4] ? {18'd0, data[35:18]} : {18'd0, data[17:0]};
      9: gather = (data >> (9 * address[4:3])) & 36'h1ff;
      4: gather = (data >> (9 * address[4:3] + 4 * address[2])) & 36'hf;
      2: gather = (data >> (9 * address[4:3] + 2 * address[2:1])) & 36'h3;
      default: gather = (data >> (9 * address[4:3] + address[2:0])) & 36'h1;
    endcase
  endfunction

  // The bits of a byte that a word takes up.
  function [8:0] part_of(input integer width, input [13:0] address);
    case (width)
      4: part_of = 9'h00f << (4 * address[2]);
      2: part_of = 9'h003 << (2 * address[2:1]);
      1: part_of = 9'h001 << address[2:0];
      default: part_of = 9'h1ff;
    endcase
  endfunction

  function [35:0] bits_of(input [3:0] bytes);
    bits_of = {{9{bytes[3]}}, {9{bytes[2]}}, {9{bytes[1]}}, {9{bytes[0]}}};
  endfunction

  wire selected_a = CEA & ~CSA2 & ~CSA1 & ~CSA0;
  wire selected_b = CEB & ~CSB2 & ~CSB1 & ~CSB0;
  wire [3:0] writes_a = selected_a & WEA ? bytes_of(DATA_WIDTH_A, ada) & enabled(DATA_WIDTH_A, ada) : 4'd0;
  wire [3:0] writes_b = selected_b & WEB ? bytes_of(DATA_WIDTH_B, adb) & enabled(DATA_WIDTH_B, adb) : 4'd0;
  wire same_row = ada[13:5] == adb[13:5];
  wire [35:0] mask_a = bits_of(writes_a) & {4{part_of(DATA_WIDTH_A, ada)}};
  wire [35:0] mask_b = bits_of(writes_b) & {4{part_of(DATA_WIDTH_B, adb)}};
  wire clash_a = same_row & |(mask_b & bits_of(bytes_of(DATA_WIDTH_A, ada)) & {4{part_of(DATA_WIDTH_A, ada)}});
  wire clash_b = same_row & |(mask_a & bits_of(bytes_of(DATA_WIDTH_B, adb)) & {4{part_of(DATA_WIDTH_B, adb)}});

  reg [35:0] read_a, read_b;
  initial begin
    read_a = 36'd0;
    read_b = 36'd0;
  end

  // A write and a read of one clock see the memory as it was before.
  wire [35:0] row_a = rows[ada[13:5]];
  wire [35:0] row_b = rows[adb[13:5]];
  always @(posedge CLKA) begin
    if (|writes_a)
      rows[ada[13:5]] <= (row_a & ~mask_a) | (spread(DATA_WIDTH_A, {dib, dia}) & mask_a);
    if (RSTA)
      read_a <= 36'd0;
    else if (selected_a & (~WEA | WRITEMODE_A == "READBEFOREWRITE"))
      read_a <= gather(DATA_WIDTH_A, ada, clash_a ? ~row_a : row_a);
  end
  always @(posedge CLKB) begin
    if (|writes_b)
      rows[adb[13:5]] <= (row_b & ~mask_b) | (spread(DATA_WIDTH_B, {18'd0, dib}) & mask_b);
    if (RSTB)
      read_b <= 36'd0;
    else if (selected_b & (~WEB | WRITEMODE_B == "READBEFOREWRITE"))
      read_b <= gather(DATA_WIDTH_B, adb, clash_b ? ~row_b : row_b);
  end

  // Two ports of up to 18 bits have pins of their own; a word of 36 bits is read through B, over both, and
  // each half has the registers and the clock enable of its pins.
  wire [17:0] pins_a = DATA_WIDTH_B == 36 ? read_b[17:0] : read_a[17:0];
  wire [17:0] pins_b = DATA_WIDTH_B == 36 ? read_b[35:18] : read_b[17:0];
  reg [17:0] held_a, held_b;
  initial begin
    held_a = 18'd0;
    held_b = 18'd0;
  end
  always @(posedge CLKA)
    if (RSTA) held_a <= 18'd0;
    else if (OCEA) held_a <= pins_a;
  always @(posedge CLKB)
    if (RSTB) held_b <= 18'd0;
    else if (OCEB) held_b <= pins_b;

  wire [17:0] doa = REGMODE_A == "OUTREG" ? held_a : pins_a;
  wire [17:0] dob = REGMODE_B == "OUTREG" ? held_b : pins_b;
  assign {DOA17, DOA16, DOA15, DOA14, DOA13, DOA12, DOA11, DOA10, DOA9} = doa[17:9];
  assign {DOA8, DOA7, DOA6, DOA5, DOA4, DOA3, DOA2, DOA1, DOA0} = doa[8:0];
  assign {DOB17, DOB16, DOB15, DOB14, DOB13, DOB12, DOB11, DOB10, DOB9} = dob[17:9];
  assign {DOB8, DOB7, DOB6, DOB5, DOB4, DOB3, DOB2, DOB1, DOB0} = dob[8:0];
endmodule
