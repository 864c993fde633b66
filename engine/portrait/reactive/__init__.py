"""Reactive profiles (section 8.1): a portrait that idles, and acts out emotions on demand.

Every clip leaves from and returns to the same picture, the target at rest; bridges lead back there from the midst of
any clip. Reading order: `pipeline`, then `states`, `excursion`, `bridges`, `document`, `bundle`.
"""
