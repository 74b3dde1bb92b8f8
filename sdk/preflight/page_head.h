// The head of a page to print, for evaluation::assemble_page. It needs no other file, and runs no script.
#pragma once
#include <string>

namespace karst::preflight {

/// `title`: plain text. What is written into the page follows the marks, so that no mark in it is taken for
/// one of them.
inline std::string page_head(const std::string& title) {
  return R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<title>)html" +
         title + R"html(</title>
<link rel="icon" href="data:,">
<style>@style@</style>
<script type="application/json" id="data">@data@</script>@libraries@@scripts@
</head>
<body>
)html";
}

}  // namespace karst::preflight
