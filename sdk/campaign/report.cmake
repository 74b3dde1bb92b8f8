# The campaign's page. The order of the scripts is that in which they run.
set(page ${CMAKE_CURRENT_SOURCE_DIR}/report/web)
set(scripts)
foreach(script svg marks verdict curves by_cave pairs spread trials replay main)
  list(APPEND scripts ${page}/${script}.js)
endforeach()
list(JOIN scripts "," script_files)
set(assets ${CMAKE_CURRENT_BINARY_DIR}/campaign_assets.cpp)
karst_embed(${assets} HEADER sdk/campaign/report/report_assets.h NAMESPACE karst::campaign
  ONE campaign_template=${page}/page.html campaign_style=${page}/campaign.css plot_style=${page}/plot.css
  MANY campaign_scripts=${script_files})

karst_library(karst_campaign_report
  report/report.cpp report/report_curves.cpp report/report_data.cpp report/report_figures.cpp
  report/report_replay.cpp report/report_worst.cpp report/verdict_json.cpp ${assets}
  LINK karst_cave_drawing karst_evaluation karst_verdict nlohmann_json::nlohmann_json)
