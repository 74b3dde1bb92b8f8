karst_test(verdict_test verdict/verdict_test.cpp verdict/overview_test.cpp verdict/drawn_campaign.cpp
  verdict/figure_words_test.cpp OPTIMIZED LINK karst_verdict rapidcheck)
