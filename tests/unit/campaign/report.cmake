karst_test(campaign_report_test
  report/report_test.cpp report/report_scene_test.cpp fake_campaign.cpp ../evaluation/fake_run.cpp
  LINK karst_campaign_report)
karst_test(campaign_report_browser_test
  report/report_browser_test.cpp fake_campaign.cpp ../evaluation/report/browser.cpp ../evaluation/fake_run.cpp
  LINK karst_campaign_report LABELS browser)

# Not a test: makes a page to look at.
add_executable(show_campaign EXCLUDE_FROM_ALL report/show_campaign.cpp fake_campaign.cpp)
target_link_libraries(show_campaign PRIVATE karst_campaign_report)
