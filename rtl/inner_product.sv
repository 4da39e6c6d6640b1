// Inner product of two directions in Q2.14, from sums and differences of their angles. Latency 6.
//
// Polar angles: C₊ + (C₋ - C₊)·k. Angles along and across a meridian (MERIDIAN): (C₋ + C₊)·k - C₊. C± are the cosines of `sum` and
// `difference`, k = (1 + cos turn)/2. The product is rounded down.
module inner_product #(
    parameter int A        = 8,
    parameter bit MERIDIAN = 0
) (
    input  logic               clk,
    input  logic        [15:0] sum,
    input  logic        [15:0] difference,
    input  logic        [15:0] turn,
    output logic signed [15:0] value
);
  logic signed [15:0] cosine_sum, cosine_difference, cosine_turn;
  cosine #(.A(A)) of_sum (.clk, .angle(sum), .value(cosine_sum));
  cosine #(.A(A)) of_difference (.clk, .angle(difference), .value(cosine_difference));
  cosine #(.A(A)) of_turn (.clk, .angle(turn), .value(cosine_turn));

  logic signed [16:0] span;
  logic signed [15:0] k, start_1, start_2;
  logic signed [32:0] scaled;
  always_ff @(posedge clk) begin
    span <= MERIDIAN ? 17'(cosine_difference) + 17'(cosine_sum) : 17'(cosine_difference) - 17'(cosine_sum);
    k <= 16'((17'sd16384 + 17'(cosine_turn)) >>> 1);
    start_1 <= cosine_sum;
    scaled <= span * k;
    start_2 <= start_1;
    value <= MERIDIAN ? 16'(19'(scaled >>> 14) - 19'(start_2)) : 16'(19'(scaled >>> 14) + 19'(start_2));
  end
endmodule
