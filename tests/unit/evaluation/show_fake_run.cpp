// show_fake_run DIR [LENGTH_M]: writes a made-up run and its report, to look at the page while working on it.
#include <cstdlib>
#include <iostream>

#include "sdk/evaluation/report/report.h"
#include "tests/unit/evaluation/fake_run.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: show_fake_run DIR [LENGTH_M]\n";
    return 2;
  }
  karst::test::FakeRunOptions options;
  if (argc > 2) options.length_m = std::atof(argv[2]);
  karst::test::write_fake_run(argv[1], options);
  karst::evaluation::write_report(argv[1]);
  return 0;
}
