karst_test(verdict_test verdict/verdict_test.cpp verdict/drawn_campaign.cpp LINK karst_verdict rapidcheck)
