karst_test(verdict_test verdict_test.cpp drawn_campaign.cpp LINK karst_verdict rapidcheck)
