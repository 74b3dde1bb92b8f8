// The `karst` command.
#include "sdk/tools/root_command.h"

int main(int argc, char** argv) { return karst::tools::karst_main(argc, argv); }
