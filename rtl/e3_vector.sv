// Unit E3, one vector: rho·[C₊ + (C₋ - C₊)·cos²(delta/2)] + y·sin(theta)·sin(delta), C± = cos(theta ± tau). Latency 10.
//
// delta is the vector's azimuth less the normal's, tau = xi + theta_N the angle of the bump vector along the meridian.
module e3_vector #(
    parameter int A = 8
) (
    input  logic               clk,
    input  logic        [15:0] phi,
    input  logic        [15:0] theta,
    input  logic        [15:0] phi_N,
    input  logic        [15:0] tau,      // a clock later than the others
    input  logic signed [15:0] rho,
    input  logic signed [15:0] y,
    output logic signed [15:0] product
);
  // Clock 1: delta, beside tau. Clock 2: all angles.
  logic [15:0] delta, theta_1, turn, sum, difference, above, below;
  always_ff @(posedge clk) begin
    delta <= phi - phi_N;
    theta_1 <= theta;
    turn <= delta;
    sum <= theta_1 + tau;
    difference <= theta_1 - tau;
    above <= theta_1 + delta;
    below <= theta_1 - delta;
  end

  // Clocks 3 to 8: the part in the meridian's plane; 3 to 6: the part across it.
  logic signed [15:0] g, cosine_above, cosine_below, across, across_late;
  inner_product #(.A(A)) in_plane (.clk, .sum, .difference, .turn, .value(g));
  cosine #(.A(A)) of_above (.clk, .angle(above), .value(cosine_above));
  cosine #(.A(A)) of_below (.clk, .angle(below), .value(cosine_below));
  always_ff @(posedge clk) across <= 16'((17'(cosine_below) - 17'(cosine_above)) >>> 1);
  delay #(.CLOCKS(2)) of_across (.clk, .early(across), .late(across_late));

  // Clock 9: products. Clock 10: their sum, exact, of which the whole part of Q2.14 is left.
  logic signed [15:0] rho_late, y_late;
  delay #(.CLOCKS(8)) of_rho (.clk, .early(rho), .late(rho_late));
  delay #(.CLOCKS(8)) of_y (.clk, .early(y), .late(y_late));
  logic signed [31:0] along_product, across_product;
  always_ff @(posedge clk) begin
    along_product <= rho_late * g;
    across_product <= y_late * across_late;
    product <= 16'((33'(along_product) + 33'(across_product)) >>> 14);
  end
endmodule
