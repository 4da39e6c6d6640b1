// Replays pixels through a unit: words in hexadecimal on stdin, a pixel a line; products on stdout, a pixel a line. With the
// argument "bubbles" there are clocks without a pixel in between. The last line is a comment: how many clocks it took, and the latency.
//
// `unit.h` names the ports in the order of the words; it is written from the model's own list.

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include "Vunit.h"
#include "unit.h"
#include "verilated.h"

int main(int argc, char** argv) {
  const bool bubbles = argc > 1 && std::strcmp(argv[1], "bubbles") == 0;
  const std::unique_ptr<VerilatedContext> context{new VerilatedContext};
  const std::unique_ptr<Vunit> unit{new Vunit{context.get()}};
  uint16_t words[UNIT_WORDS] = {};
  uint64_t clocks = 0, first_in = 0, first_out = 0, taken = 0, given = 0;
  uint32_t noise = 1;

  unit->reset = 1;
  unit->valid_in = 0;
  const auto clock = [&] {
    unit->clk = 0;
    unit->eval();
    unit->clk = 1;
    unit->eval();
    ++clocks;
  };
  // What is left of before the reset must not come out as a result.
  for (int i = 0; i < 64; ++i) clock();
  unit->reset = 0;

  bool more = true;
  while (more || given < taken) {
    noise = noise * 1664525u + 1013904223u;
    unit->valid_in = 0;
    if (more && !(bubbles && (noise >> 30) == 0)) {
      for (uint16_t& word : words) more = more && std::scanf("%4hx", &word) == 1;
      if (more) {
        drive(*unit, words);
        unit->valid_in = 1;
        if (taken++ == 0) first_in = clocks;
      }
    }
    clock();
    if (unit->valid_out) {
      if (given++ == 0) first_out = clocks;
      std::printf("%04x %04x\n", unsigned(unit->product_L), unsigned(unit->product_H));
    }
    if (!more && taken == 0) break;
  }
  std::printf("// %llu %llu\n", (unsigned long long)(clocks - first_in), (unsigned long long)(first_out - first_in));
  unit->final();
  return 0;
}
