// Sine and cosine of a binary angle (a turn is 2^16) in Q2.14, from one table with both side by side. Latency 3.
//
// The angle is rounded to the nearest of 2^(A+2) steps a turn. In every second quadrant sine and cosine change places.
module sine_cosine #(
    parameter int A = 8
) (
    input  logic               clk,
    input  logic        [15:0] angle,
    output logic signed [15:0] sine,
    output logic signed [15:0] cosine
);
  localparam logic [15:0] HALF_STEP = 16'(1 << (13 - A));

  logic [A+1:0] step;
  assign step = (A + 2)'((angle + HALF_STEP) >> (14 - A));

  logic [A-1:0] address;
  logic [1:0] quadrant_1, quadrant_2;
  logic [31:0] words;
  rom #(.A(A), .WIDTH(32), .FILE("rom/sine_cosine.hex")) quarter (.clk, .address, .word(words));

  logic signed [15:0] rising, falling;
  assign {falling, rising} = quadrant_2[0] ? {words[15:0], words[31:16]} : words;
  always_ff @(posedge clk) begin
    address <= step[A-1:0];
    quadrant_1 <= step[A+1:A];
    quadrant_2 <= quadrant_1;
    sine <= quadrant_2[1] ? -rising : rising;
    cosine <= quadrant_2[1] ^ quadrant_2[0] ? -falling : falling;
  end
endmodule
