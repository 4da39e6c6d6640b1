// Unit E4: exact inner products N'·L' and N'·H' with two multipliers a vector, one pair a clock. Latency 22.
//
// Angles are binary (a turn is 2^16), products Q2.14. The bump vector is given by its angles along and across the normal's meridian.
module e4 #(
    parameter int A = 8
) (
    input  logic        clk,
    input  logic        reset,
    input  logic        valid_in,
    input  logic [15:0] phi_L,
    input  logic [15:0] theta_L,
    input  logic [15:0] phi_H,
    input  logic [15:0] theta_H,
    input  logic [15:0] phi_N,
    input  logic [15:0] theta_N,
    input  logic [15:0] xi_bump,
    input  logic [15:0] eta_bump,
    output logic        valid_out,
    output logic [15:0] product_L,
    output logic [15:0] product_H
);
  logic [15:0] light_phi, light_theta, half_phi, half_theta, normal_phi, normal_theta, xi, eta;
  always_ff @(posedge clk) begin
    {light_phi, light_theta, half_phi, half_theta} <= {phi_L, theta_L, phi_H, theta_H};
    {normal_phi, normal_theta, xi, eta} <= {phi_N, theta_N, xi_bump, eta_bump};
  end
  e4_vector #(.A(A)) light (
      .clk, .phi(light_phi), .theta(light_theta), .phi_N(normal_phi), .theta_N(normal_theta),
      .bump_along(xi), .bump_across(eta), .product(product_L)
  );
  e4_vector #(.A(A)) half (
      .clk, .phi(half_phi), .theta(half_theta), .phi_N(normal_phi), .theta_N(normal_theta),
      .bump_along(xi), .bump_across(eta), .product(product_H)
  );
  valid_chain #(.CLOCKS(22)) valid (.clk, .reset, .valid_in, .valid_out);
endmodule
