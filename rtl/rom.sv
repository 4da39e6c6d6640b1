// A table of 2^A words, read in one clock. What it holds is in FILE, for $readmemh.
module rom #(
    parameter int A     = 8,
    parameter int WIDTH = 16,
    parameter     FILE  = "rom/sine.hex"
) (
    input  logic             clk,
    input  logic [    A-1:0] address,
    output logic [WIDTH-1:0] word
);
  logic [WIDTH-1:0] words[1<<A];
  initial $readmemh(FILE, words);
  always_ff @(posedge clk) word <= words[address];
endmodule
