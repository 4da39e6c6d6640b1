// Cosine of a binary angle (a turn is 2^16) in Q2.14. Latency 3.
//
// The table holds a quarter wave of the sine. The angle is rounded to the nearest of 2^(A+2) steps a turn; the quadrant says
// from which end the table is read and what sign the word gets. The step at the end of the quarter is not stored: it is 1.
module cosine #(
    parameter int A = 8
) (
    input  logic               clk,
    input  logic        [15:0] angle,
    output logic signed [15:0] value
);
  // A quarter turn ahead of the angle the sine is its cosine; half a step, so that rounding down is rounding to the nearest.
  localparam logic [15:0] AHEAD = 16'h4000 + 16'(1 << (13 - A));

  logic [A+1:0] step;
  assign step = (A + 2)'((angle + AHEAD) >> (14 - A));
  logic [A:0] place;
  assign place = step[A] ? (A + 1)'(1 << A) - {1'b0, step[A-1:0]} : {1'b0, step[A-1:0]};

  logic [A-1:0] address;
  logic is_end_1, is_end_2, is_negative_1, is_negative_2;
  logic signed [15:0] word;
  rom #(.A(A), .FILE("rom/sine.hex")) quarter (.clk, .address, .word);

  logic signed [15:0] magnitude;
  assign magnitude = is_end_2 ? 16'sd16384 : word;
  always_ff @(posedge clk) begin
    address <= place[A-1:0];
    {is_end_1, is_negative_1} <= {place[A], step[A+1]};
    {is_end_2, is_negative_2} <= {is_end_1, is_negative_1};
    value <= is_negative_2 ? -magnitude : magnitude;
  end
endmodule
