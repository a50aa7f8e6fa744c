;; Emacs with lsp-mode: in init.el.
(define-derived-mode motion-script-mode prog-mode "Motion Script"
  (setq-local comment-start "# ")
  (setq-local comment-start-skip "#+\\s-*"))
(add-to-list 'auto-mode-alist '("\\.ms\\'" . motion-script-mode))
(with-eval-after-load 'lsp-mode
  (add-to-list 'lsp-language-id-configuration '(motion-script-mode . "motion-script"))
  (lsp-register-client
   (make-lsp-client :new-connection (lsp-stdio-connection
                                     '("mlmg" "lsp" "--stdio" "--position-encoding" "utf-32"))
                    :activation-fn (lsp-activate-on "motion-script")
                    :server-id 'mlmg)))
(add-hook 'motion-script-mode-hook #'lsp-deferred)
