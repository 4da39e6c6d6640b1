// The published unit with its equations mended, one vector: rotation by angles, eqs. (5)-(9), (16)-(18), then the inner product of
// eqs. (24), (25). Latency 31.
module published_vector #(
    parameter int A = 8
) (
    input  logic               clk,
    input  logic        [15:0] phi,
    input  logic        [15:0] theta,
    input  logic        [15:0] phi_N,
    input  logic        [15:0] theta_N,
    input  logic        [15:0] bump_phi,
    input  logic        [15:0] bump_theta,
    output logic signed [15:0] product
);
  // Clocks 1 to 7.
  logic [14:0] width, height;
  logic is_left, is_below;
  projection #(.A(A)) plane (.clk, .phi, .theta, .phi_N, .width, .is_left, .height, .is_below);

  // Clocks 8 to 10: the arc sine, which loses the sign of z. Clock 11: beyond 90°. Clock 12: left. Clock 13: Z.
  logic [15:0] arc, theta_10, theta_N_12, theta_x_11, theta_x_12, z;
  logic is_left_11;
  arc_sine #(.A(A)) of_width (.clk, .magnitude(width), .arc);
  delay #(.CLOCKS(10)) of_theta (.clk, .early(theta), .late(theta_10));
  delay #(.CLOCKS(12)) of_theta_N (.clk, .early(theta_N), .late(theta_N_12));
  delay #(.WIDTH(1), .CLOCKS(4)) of_left (.clk, .early(is_left), .late(is_left_11));
  always_ff @(posedge clk) begin
    theta_x_11 <= theta_10 > 16'h4000 ? 16'h8000 - arc : arc;
    theta_x_12 <= is_left_11 ? -theta_x_11 : theta_x_11;
    z <= theta_x_12 - theta_N_12;
  end

  // Clock 14: |Z|, half a turn at most. Clock 15: mirrored at 90°. Clock 16: both addresses. Clock 17: secant and cosecant of Z.
  logic [15:0] size_14, size_15;
  logic is_behind_14;
  /* verilator lint_off UNUSEDSIGNAL */ // Addresses are rounded down.
  logic [14:0] acute, rest_of_quarter;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [A-1:0] secant_address, cosecant_address;
  logic [15:0] secant, cosecant;
  assign rest_of_quarter = 15'h4000 - acute;
  rom_two_ports #(.A(A), .FILE("rom/secant.hex")) secants (
      .clk, .address_a(secant_address), .address_b(cosecant_address), .word_a(secant), .word_b(cosecant)
  );
  always_ff @(posedge clk) begin
    size_14 <= z[15] ? -z : z;
    is_behind_14 <= z[15];
    size_15 <= size_14;
    acute <= 15'(size_14 > 16'h4000 ? 16'h8000 - size_14 : size_14);
    secant_address <= acute[14] ? '1 : acute[13-:A];
    cosecant_address <= rest_of_quarter[14] ? '1 : rest_of_quarter[13-:A];
  end

  // Clock 18: y/cos Z and y/sin Z, Q6.10. Clocks 19 and 20: addresses. Clock 21: proportion and arc.
  logic [14:0] height_17;
  delay #(.WIDTH(15), .CLOCKS(10)) of_height (.clk, .early(height), .late(height_17));
  /* verilator lint_off UNUSEDSIGNAL */ // Quotients are rounded down.
  logic [30:0] over_cosine, over_sine;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [A-1:0] proportion_address_19, proportion_address, arc_address;
  logic [15:0] proportion_word, arc_word;
  log_address #(.A(A)) of_quotient (.clk, .quotient(over_sine[30:14]), .address(arc_address));
  rom #(.A(A), .FILE("rom/proportion.hex")) proportions (.clk, .address(proportion_address), .word(proportion_word));
  rom #(.A(A), .FILE("rom/log_arc_tangent.hex")) arcs (.clk, .address(arc_address), .word(arc_word));
  // Q6.10 with four zeros below it is Q2.14: what is 1 and more takes the last word.
  /* verilator lint_off UNUSEDSIGNAL */ // Addresses are rounded down.
  logic [13:0] fraction;
  /* verilator lint_on UNUSEDSIGNAL */
  assign fraction = {over_cosine[23:14], 4'd0};
  always_ff @(posedge clk) begin
    over_cosine <= height_17 * secant;
    over_sine <= height_17 * cosecant;
    proportion_address_19 <= over_cosine[30:24] != 0 ? '1 : fraction[13-:A];
    proportion_address <= proportion_address_19;
  end

  // Clock 22: the arc, behind or not; what is left of the quarter. Clock 23: azimuth's sign; the part of the rest. Clock 24: angles.
  logic is_flat_21, is_behind_21, is_below_22;
  logic [15:0] size_21, size_23;
  delay #(.WIDTH(1), .CLOCKS(14)) of_flat (.clk, .early(height == 15'd0), .late(is_flat_21));
  delay #(.WIDTH(1), .CLOCKS(7)) of_behind (.clk, .early(is_behind_14), .late(is_behind_21));
  delay #(.WIDTH(1), .CLOCKS(15)) of_below (.clk, .early(is_below), .late(is_below_22));
  delay #(.CLOCKS(6)) of_size (.clk, .early(size_15), .late(size_21));
  delay #(.CLOCKS(2)) of_size_late (.clk, .early(size_21), .late(size_23));
  logic [15:0] turned, azimuth_22, azimuth_23, azimuth, polar, proportion;
  logic signed [16:0] rest;
  logic signed [33:0] part;
  assign turned = is_flat_21 ? 16'd0 : arc_word;
  always_ff @(posedge clk) begin
    azimuth_22 <= is_behind_21 ? 16'h8000 - turned : turned;
    proportion <= is_flat_21 ? 16'd0 : proportion_word;
    rest <= 17'sh04000 - $signed({1'b0, size_21});
    azimuth_23 <= is_below_22 ? -azimuth_22 : azimuth_22;
    part <= rest * $signed({1'b0, proportion});
    azimuth <= azimuth_23;
    polar <= 16'(18'(part >>> 16) + $signed({2'b0, size_23}));
  end

  // Clock 25: sums and differences. Clocks 26 to 31: the inner product.
  logic [15:0] bump_phi_late, bump_theta_late, sum, difference, turn;
  delay #(.CLOCKS(24)) of_bump_phi (.clk, .early(bump_phi), .late(bump_phi_late));
  delay #(.CLOCKS(24)) of_bump_theta (.clk, .early(bump_theta), .late(bump_theta_late));
  always_ff @(posedge clk) begin
    sum <= polar + bump_theta_late;
    difference <= polar - bump_theta_late;
    turn <= azimuth - bump_phi_late;
  end
  inner_product #(.A(A)) inner (.clk, .sum, .difference, .turn, .value(product));
endmodule
