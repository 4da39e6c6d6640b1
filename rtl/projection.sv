// Components of a vector along (x) and across (y) the meridian of a normal at azimuth phi_N: sin(theta)·cos(delta) and
// sin(theta)·sin(delta), from the sines and cosines of theta + delta and theta - delta; as magnitudes in Q2.14, at most 1, and signs.
// Latency 7.
module projection #(
    parameter int A = 8
) (
    input  logic        clk,
    input  logic [15:0] phi,
    input  logic [15:0] theta,
    input  logic [15:0] phi_N,
    output logic [14:0] width,     // |x|
    output logic        is_left,   // x < 0
    output logic [14:0] height,    // |y|
    output logic        is_below   // y < 0
);
  logic [15:0] delta, theta_1, above, below;
  logic signed [15:0] sine_above, cosine_above, sine_below, cosine_below, x, y;
  sine_cosine #(.A(A)) wave_above (.clk, .angle(above), .sine(sine_above), .cosine(cosine_above));
  sine_cosine #(.A(A)) wave_below (.clk, .angle(below), .sine(sine_below), .cosine(cosine_below));
  always_ff @(posedge clk) begin
    delta <= phi - phi_N;
    theta_1 <= theta;
    above <= theta_1 + delta;
    below <= theta_1 - delta;
    // Halves, rounded down.
    x <= 16'((17'(sine_above) + 17'(sine_below)) >>> 1);
    y <= 16'((17'(cosine_below) - 17'(cosine_above)) >>> 1);
    width <= 15'(x < 0 ? -x : x);
    height <= 15'(y < 0 ? -y : y);
    is_left <= x < 0;
    is_below <= y < 0;
  end
endmodule
