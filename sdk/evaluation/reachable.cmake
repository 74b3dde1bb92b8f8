karst_library(karst_reachable cell_set.cpp triangle_cells.cpp open_cave.cpp sight.cpp reachable.cpp surface.cpp
              LINK karst_cave karst_common)
