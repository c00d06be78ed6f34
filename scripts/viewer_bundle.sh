#!/usr/bin/env bash
# Builds the viewer's page from viewer/ into crates/viewer/assets/*.js, which are committed. Needs npm.
set -euo pipefail
cd "$(dirname "$0")/../viewer"
npm ci --ignore-scripts --no-audit --no-fund
npm run check
npm run bundle
