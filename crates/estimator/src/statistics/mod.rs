//! Performance measures of estimators, each with its Monte-Carlo standard error.
