// A word some clocks later.
module delay #(
    parameter int WIDTH  = 16,
    parameter int CLOCKS = 1
) (
    input  logic             clk,
    input  logic [WIDTH-1:0] early,
    output logic [WIDTH-1:0] late
);
  logic [WIDTH-1:0] stages[CLOCKS];
  always_ff @(posedge clk) begin
    stages[0] <= early;
    for (int i = 1; i < CLOCKS; i++) stages[i] <= stages[i-1];
  end
  assign late = stages[CLOCKS-1];
endmodule
