/* lab_report.h - mimdsim lab report: an attempt as one page to hand in. */
#ifndef APP_LAB_REPORT_H
#define APP_LAB_REPORT_H

#include <stdbool.h>

#include "app/verb.h"
#include "base/arena.h"
#include "base/err.h"

/* lab_report: checks the attempt in `folder`, makes its runs and those of every place of the
 * lesson's sliders, and writes folder/report.html (lab_page.h), whose name becomes *path, in `a`. A
 * program that fails is part of the report: *right tells whether all answers are. Returns false as
 * lab_check, plan_read and lab_page_write. */
bool lab_report(const struct common *c, const char *folder, struct arena *a, const char **path,
                bool *right, struct err *e);

#endif
