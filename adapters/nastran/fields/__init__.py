"""Where values stand on cards, and how a user names them."""
