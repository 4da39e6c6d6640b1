// Arc sine of a magnitude in Q2.14, 0 to 1, as a binary angle. 0 and 1 are exact. Latency 3.
module arc_sine #(
    parameter int A = 8
) (
    input  logic        clk,
    input  logic [14:0] magnitude,
    output logic [15:0] arc
);
  logic [A-1:0] address;
  logic is_zero_1, is_zero_2, is_one_1, is_one_2;
  logic [15:0] word;
  rom #(.A(A), .FILE("rom/arc_sine.hex")) arcs (.clk, .address, .word);
  always_ff @(posedge clk) begin
    address <= magnitude[14] ? '1 : magnitude[13-:A];
    {is_zero_1, is_one_1} <= {magnitude == 15'd0, magnitude[14]};
    {is_zero_2, is_one_2} <= {is_zero_1, is_one_1};
    arc <= is_zero_2 ? 16'd0 : is_one_2 ? 16'h4000 : word;
  end
endmodule
