// A table of 2^A words that is read at two addresses in one clock. What it holds is in FILE, for $readmemh.
module rom_two_ports #(
    parameter int A    = 8,
    parameter     FILE = "rom/secant.hex"
) (
    input  logic         clk,
    input  logic [A-1:0] address_a,
    input  logic [A-1:0] address_b,
    output logic [ 15:0] word_a,
    output logic [ 15:0] word_b
);
  logic [15:0] words[1<<A];
  initial $readmemh(FILE, words);
  always_ff @(posedge clk) begin
    word_a <= words[address_a];
    word_b <= words[address_b];
  end
endmodule
