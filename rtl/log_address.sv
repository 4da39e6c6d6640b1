// The address of a Q6.10 number in a table by its logarithm: four bits of exponent, the A - 4 bits after the leading one. In the
// lowest octave there is no leading one. Latency 2.
module log_address #(
    parameter int A = 8
) (
    input  logic         clk,
    input  logic [ 16:0] quotient,
    output logic [A-1:0] address
);
  localparam int M = A - 4;

  // The place of the leading one.
  logic [15:0] limited_now, limited;
  logic [3:0] exponent_now, exponent;
  assign limited_now = quotient[16] ? 16'hffff : quotient[15:0];
  always_comb begin
    exponent_now = 4'd0;
    for (int i = 1; i < 16; i++) if (limited_now[i]) exponent_now = 4'(i);
  end
  always_ff @(posedge clk) {limited, exponent} <= {limited_now, exponent_now};

  // Shifted until the leading one stands at bit 15; what follows it is the mantissa.
  /* verilator lint_off UNUSEDSIGNAL */ // The leading one is known, and what is below the mantissa dropped.
  logic [15:0] aligned;
  /* verilator lint_on UNUSEDSIGNAL */
  assign aligned = limited << (4'd15 - exponent);
  generate
    if (M == 0) always_ff @(posedge clk) address <= exponent;
    else begin : with_mantissa
      // 1 and 0 share the lowest octave, halved.
      logic [M-1:0] mantissa;
      assign mantissa = limited < 16'd2 ? {limited[0], {(M - 1) {1'b0}}} : aligned[14-:M];
      always_ff @(posedge clk) address <= {exponent, mantissa};
    end
  endgenerate
endmodule
