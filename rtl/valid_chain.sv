// Whether a result is one: what `valid_in` was as many clocks ago. A reset empties it.
module valid_chain #(
    parameter int CLOCKS = 2
) (
    input  logic clk,
    input  logic reset,
    input  logic valid_in,
    output logic valid_out
);
  logic [CLOCKS-1:0] stages;
  always_ff @(posedge clk) stages <= reset ? '0 : {stages[CLOCKS-2:0], valid_in};
  assign valid_out = stages[CLOCKS-1];
endmodule
