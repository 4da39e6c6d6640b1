// Unit E4, one vector: its angles along and across the normal's meridian, then the inner product with the bump vector's. Latency 21.
//
// across = asin(y), along = atan2(x, z) - theta_N; the tangent x/cos(theta) is taken of positive numbers and the arc folded back.
module e4_vector #(
    parameter int A = 8
) (
    input  logic               clk,
    input  logic        [15:0] phi,
    input  logic        [15:0] theta,
    input  logic        [15:0] phi_N,
    input  logic        [15:0] theta_N,
    input  logic        [15:0] bump_along,
    input  logic        [15:0] bump_across,
    output logic signed [15:0] product
);
  // Clocks 1 to 7.
  logic [14:0] width, height;
  logic is_left, is_below;
  projection #(.A(A)) plane (.clk, .phi, .theta, .phi_N, .width, .is_left, .height, .is_below);

  // Clocks 8 to 11: the angle across, with y's sign.
  logic [15:0] arc_across, across;
  logic is_below_late;
  arc_sine #(.A(A)) of_height (.clk, .magnitude(height), .arc(arc_across));
  delay #(.WIDTH(1), .CLOCKS(3)) of_below (.clk, .early(is_below), .late(is_below_late));
  always_ff @(posedge clk) across <= is_below_late ? -arc_across : arc_across;

  // Up to clock 7: the secant of theta, mirrored at 90°.
  logic [15:0] theta_4;
  delay #(.CLOCKS(4)) of_theta (.clk, .early(theta), .late(theta_4));
  logic is_beyond_5, is_beyond_11;
  /* verilator lint_off UNUSEDSIGNAL */ // Addresses are rounded down.
  logic [14:0] acute;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [A-1:0] secant_address;
  logic [15:0] secant;
  rom #(.A(A), .FILE("rom/secant.hex")) secants (.clk, .address(secant_address), .word(secant));
  always_ff @(posedge clk) begin
    is_beyond_5 <= theta_4 > 16'h4000;
    acute <= 15'(theta_4 > 16'h4000 ? 16'h8000 - theta_4 : theta_4);
    secant_address <= acute[14] ? '1 : acute[13-:A];
  end
  delay #(.WIDTH(1), .CLOCKS(6)) of_beyond (.clk, .early(is_beyond_5), .late(is_beyond_11));

  // Clock 8: the tangent, Q6.10. Clocks 9 and 10: its logarithm. Clock 11: its arc.
  /* verilator lint_off UNUSEDSIGNAL */ // Quotients are rounded down.
  logic [30:0] quotient;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [A-1:0] arc_address;
  logic [15:0] arc_word;
  log_address #(.A(A)) of_quotient (.clk, .quotient(quotient[30:14]), .address(arc_address));
  rom #(.A(A), .FILE("rom/log_arc_tangent.hex")) arcs (.clk, .address(arc_address), .word(arc_word));
  always_ff @(posedge clk) quotient <= width * secant;

  // Clock 12: beyond 90°. Clock 13: left of the meridian. Clock 14: rotation, by a subtraction.
  logic is_on_meridian_11, is_left_12;
  delay #(.WIDTH(1), .CLOCKS(4)) of_zero (.clk, .early(width == 15'd0), .late(is_on_meridian_11));
  delay #(.WIDTH(1), .CLOCKS(5)) of_left (.clk, .early(is_left), .late(is_left_12));
  logic [15:0] arc, theta_N_13, along_12, along_13, along;
  assign arc = is_on_meridian_11 ? 16'd0 : arc_word;
  delay #(.CLOCKS(13)) of_theta_N (.clk, .early(theta_N), .late(theta_N_13));
  always_ff @(posedge clk) begin
    along_12 <= is_beyond_11 ? 16'h8000 - arc : arc;
    along_13 <= is_left_12 ? -along_12 : along_12;
    along <= along_13 - theta_N_13;
  end

  // Clock 15: sums and differences. Clocks 16 to 21: the inner product.
  logic [15:0] across_late, bump_along_late, bump_across_late, sum, difference, turn;
  delay #(.CLOCKS(3)) of_across (.clk, .early(across), .late(across_late));
  delay #(.CLOCKS(14)) of_bump_along (.clk, .early(bump_along), .late(bump_along_late));
  delay #(.CLOCKS(14)) of_bump_across (.clk, .early(bump_across), .late(bump_across_late));
  always_ff @(posedge clk) begin
    sum <= bump_across_late + across_late;
    difference <= bump_across_late - across_late;
    turn <= bump_along_late - along;
  end
  inner_product #(.A(A), .MERIDIAN(1)) inner (.clk, .sum, .difference, .turn, .value(product));
endmodule
