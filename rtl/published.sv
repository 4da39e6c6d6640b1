// The published unit with its equations mended: inner products N'·L' and N'·H' as its method has them, one pair a clock. Latency 32.
//
// Angles are binary (a turn is 2^16), products Q2.14. The bump vector is polar, in the normal's reference frame.
module published #(
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
    input  logic [15:0] phi_bump,
    input  logic [15:0] theta_bump,
    output logic        valid_out,
    output logic [15:0] product_L,
    output logic [15:0] product_H
);
  logic [15:0] light_phi, light_theta, half_phi, half_theta, normal_phi, normal_theta, bump_phi, bump_theta;
  always_ff @(posedge clk) begin
    {light_phi, light_theta, half_phi, half_theta} <= {phi_L, theta_L, phi_H, theta_H};
    {normal_phi, normal_theta, bump_phi, bump_theta} <= {phi_N, theta_N, phi_bump, theta_bump};
  end
  published_vector #(.A(A)) light (
      .clk, .phi(light_phi), .theta(light_theta), .phi_N(normal_phi), .theta_N(normal_theta),
      .bump_phi, .bump_theta, .product(product_L)
  );
  published_vector #(.A(A)) half (
      .clk, .phi(half_phi), .theta(half_theta), .phi_N(normal_phi), .theta_N(normal_theta),
      .bump_phi, .bump_theta, .product(product_H)
  );
  valid_chain #(.CLOCKS(32)) valid (.clk, .reset, .valid_in, .valid_out);
endmodule
