/*
 * karst policy ABI 1.0: policies in files of a language with a run time of its own, such as Python.
 *
 * A language is a shared object in lib/karst/languages, named by the ending of its files: py.so opens *.py.
 * It exports exactly `karst_script_entry`. What that returns is a plugin like any other: the host makes the
 * same handshake, and calls the same tables.
 */
#ifndef KARST_ABI_SCRIPT_H
#define KARST_ABI_SCRIPT_H
#include "karst_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

/* [any thread] The plugin that a file holds, or NULL with the error filled: file, line and reason. May run
   the file. The table lives as long as the process; a file that was opened before gives the same table. */
typedef const karst_plugin_t* (*karst_script_entry_fn)(karst_text_t file, karst_error_t*)KARST_NOEXCEPT;

#define KARST_SCRIPT_ENTRY_NAME "karst_script_entry"

/* Defined by the language, with external visibility. */
KARST_EXPORT const karst_plugin_t* karst_script_entry(karst_text_t file, karst_error_t*) KARST_NOEXCEPT;

#ifdef __cplusplus
}
#endif
#endif
