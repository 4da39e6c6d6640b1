// Unit E3: exact inner products N'·L' and N'·H', one pair a clock. Latency 11.
//
// Angles are binary (a turn is 2^16), numbers and products Q2.14. The bump vector is (rho·sin xi, y, rho·cos xi) in the normal's
// meridian frame. 6 multipliers, 10 tables of 2^A words.
module e3 #(
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
    input  logic [15:0] rho_bump,
    input  logic [15:0] y_bump,
    output logic        valid_out,
    output logic [15:0] product_L,
    output logic [15:0] product_H
);
  logic [15:0] light_phi, light_theta, half_phi, half_theta, normal_phi, normal_theta, xi, rho, y;
  // tau once for both vectors.
  logic [15:0] tau;
  always_ff @(posedge clk) begin
    {light_phi, light_theta, half_phi, half_theta} <= {phi_L, theta_L, phi_H, theta_H};
    {normal_phi, normal_theta, xi, rho, y} <= {phi_N, theta_N, xi_bump, rho_bump, y_bump};
    tau <= xi + normal_theta;
  end
  e3_vector #(.A(A)) light (.clk, .phi(light_phi), .theta(light_theta), .phi_N(normal_phi), .tau, .rho, .y, .product(product_L));
  e3_vector #(.A(A)) half (.clk, .phi(half_phi), .theta(half_theta), .phi_N(normal_phi), .tau, .rho, .y, .product(product_H));
  valid_chain #(.CLOCKS(11)) valid (.clk, .reset, .valid_in, .valid_out);
endmodule
