karst_library(karst_reachable cell_set.cpp triangle_cells.cpp open_cave.cpp sight.cpp reachable.cpp reachable_file.cpp surface.cpp imaged_rock.cpp
              LINK karst_evaluation karst_cave karst_common)
